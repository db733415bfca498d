/* quadrotor_ud: Extended Kalman filter of the plant "quadrotor6", in single precision.
 *
 * Written by plantc 0.1.0 from model f4dfb1d1. Do not edit: change the model, export again.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 *
 *    x' = vx
 *    vx' = (sin(yaw) sin(roll) + cos(yaw) sin(pitch)) cos(roll) (5.42e-05 (rotor_1^2 + rotor_2^2 + rotor_3^2 +
 *         rotor_4^2))
 *    y' = vy
 *    vy' = (sin(yaw) sin(pitch) - cos(yaw) sin(roll)) cos(roll) (5.42e-05 (rotor_1^2 + rotor_2^2 + rotor_3^2 +
 *         rotor_4^2))
 *    z' = vz
 *    vz' = cos(pitch) cos(roll) (5.42e-05 (rotor_1^2 + rotor_2^2 + rotor_3^2 + rotor_4^2)) - 9.81
 *    roll' = roll_rate
 *    roll_rate' = -0.753086419753 (pitch_rate yaw_rate) - 0.0128395061728 pitch_rate (rotor_1 - rotor_2 + rotor_3 -
 *         rotor_4) + 0.00160592592593 (rotor_3^2 - (rotor_1^2 + rotor_2^2) + rotor_4^2)
 *    pitch' = pitch_rate
 *    pitch_rate' = 0.753086419753 (roll_rate yaw_rate) + 0.0128395061728 roll_rate (rotor_1 - rotor_2 + rotor_3 -
 *         rotor_4) + 0.00160592592593 (rotor_2^2 - rotor_1^2 + rotor_3^2 - rotor_4^2)
 *    yaw' = yaw_rate
 *    yaw_rate' = 1.1e-06 (rotor_1^2 - rotor_2^2 + rotor_3^2 - rotor_4^2) / 0.0142
 *    pose[0] = x + noise
 *    pose[1] = y + noise
 *    pose[2] = z + noise
 *    pose[3] = roll + noise
 *    pose[4] = pitch + noise
 *    pose[5] = yaw + noise
 *
 * dt = 0.025 s.
 * Discretised by euler.
 * Covariance as factors U D U' (Bierman and Thornton), packed: D on the diagonal, U beside it.
 * Mathematics: plantc's own, in the source; largest errors: cos (1.5 ulp), sin (1.5 ulp). The same bits on every
 * machine if built with -ffp-contract=off.
 * No heap, no globals, no recursion. One state for each instance, used by one context at a time. A call that returns a
 * negative status leaves the state and the outputs exactly as they were. Positive: degraded, the highest is returned.
 * Assumes the FPU rounds to nearest and keeps denormals and NaN (no flush to zero, no default NaN, no -ffast-math).
 */
#ifndef QUADROTOR_UD_H
#define QUADROTOR_UD_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum
{
    QUADROTOR_UD_OK = 0,              /* ok */
    QUADROTOR_UD_GATED = 1,           /* innovation beyond the gate: reading not used */
    QUADROTOR_UD_CLAMPED = 2,         /* a value (a variance, a command) was held at its limit */
    QUADROTOR_UD_SKIPPED = 3,         /* a sensor was refused and skipped: see its own status */
    QUADROTOR_UD_RECOVERED = 4,       /* gated too often in a row: P inflated, reading taken without gate */
    QUADROTOR_UD_BAD_INPUT = -1,      /* an input is outside its range, or not a number */
    QUADROTOR_UD_BAD_PARAM = -2,      /* a parameter is outside its range, or not a number */
    QUADROTOR_UD_NOT_POSITIVE = -3,   /* a variance would not be positive */
    QUADROTOR_UD_OVERFLOW = -4        /* the result would leave its range */
} quadrotor_ud_status_t;

/* What may be tuned without exporting again. Start from QUADROTOR_UD_PARAMS_DEFAULT. */
typedef struct
{
    float variance_step_x;           /* noise per step of x                                 [m^2]        0 .. 1e6 */
    float variance_step_vx;          /* noise per step of vx                                [m^2/s^2]    0 .. 1e6 */
    float variance_step_y;           /* noise per step of y                                 [m^2]        0 .. 1e6 */
    float variance_step_vy;          /* noise per step of vy                                [m^2/s^2]    0 .. 1e6 */
    float variance_step_z;           /* noise per step of z                                 [m^2]        0 .. 1e6 */
    float variance_step_vz;          /* noise per step of vz                                [m^2/s^2]    0 .. 1e6 */
    float variance_step_roll;        /* noise per step of roll                              [rad^2]      0 .. 1e6 */
    float variance_step_roll_rate;   /* noise per step of roll_rate                         [rad^2/s^2]  0 .. 1e6 */
    float variance_step_pitch;       /* noise per step of pitch                             [rad^2]      0 .. 1e6 */
    float variance_step_pitch_rate;  /* noise per step of pitch_rate                        [rad^2/s^2]  0 .. 1e6 */
    float variance_step_yaw;         /* noise per step of yaw                               [rad^2]      0 .. 1e6 */
    float variance_step_yaw_rate;    /* noise per step of yaw_rate                          [rad^2/s^2]  0 .. 1e6 */
    float variance_pose[6];          /* noise of pose                                                    1e-12 .. 1e6 */
    float gate_pose;                 /* largest accepted NIS of pose; 0: no gate                         0 .. 1e6 */
    uint32_t reject_limit;           /* readings gated in a row after which step recovers; 0: never */
    float inflation;                 /* factor on P at a recovery                                        1 .. 1e6 */
    /* initial x */
    float x_0;                       /* [m]  -10000 .. 10000 */
    /* initial vx */
    float vx_0;                      /* [m/s]  -1000 .. 1000 */
    /* initial y */
    float y_0;                       /* [m]  -10000 .. 10000 */
    /* initial vy */
    float vy_0;                      /* [m/s]  -1000 .. 1000 */
    /* initial z */
    float z_0;                       /* [m]  -10000 .. 10000 */
    /* initial vz */
    float vz_0;                      /* [m/s]  -1000 .. 1000 */
    float roll_0;                    /* initial roll                                        [rad]        -30 .. 30 */
    float roll_rate_0;               /* initial roll_rate                                   [rad/s]      -100 .. 100 */
    float pitch_0;                   /* initial pitch                                       [rad]        -30 .. 30 */
    float pitch_rate_0;              /* initial pitch_rate                                  [rad/s]      -100 .. 100 */
    float yaw_0;                     /* initial yaw                                         [rad]        -30 .. 30 */
    float yaw_rate_0;                /* initial yaw_rate                                    [rad/s]      -100 .. 100 */
    float variance_x_0;              /* variance of the error of x_0                        [m^2]        1e-12 .. 1e6 */
    float variance_vx_0;             /* variance of the error of vx_0                       [m^2/s^2]    1e-12 .. 1e6 */
    float variance_y_0;              /* variance of the error of y_0                        [m^2]        1e-12 .. 1e6 */
    float variance_vy_0;             /* variance of the error of vy_0                       [m^2/s^2]    1e-12 .. 1e6 */
    float variance_z_0;              /* variance of the error of z_0                        [m^2]        1e-12 .. 1e6 */
    float variance_vz_0;             /* variance of the error of vz_0                       [m^2/s^2]    1e-12 .. 1e6 */
    float variance_roll_0;           /* variance of the error of roll_0                     [rad^2]      1e-12 .. 1e6 */
    float variance_roll_rate_0;      /* variance of the error of roll_rate_0                [rad^2/s^2]  1e-12 .. 1e6 */
    float variance_pitch_0;          /* variance of the error of pitch_0                    [rad^2]      1e-12 .. 1e6 */
    float variance_pitch_rate_0;     /* variance of the error of pitch_rate_0               [rad^2/s^2]  1e-12 .. 1e6 */
    float variance_yaw_0;            /* variance of the error of yaw_0                      [rad^2]      1e-12 .. 1e6 */
    float variance_yaw_rate_0;       /* variance of the error of yaw_rate_0                 [rad^2/s^2]  1e-12 .. 1e6 */
} quadrotor_ud_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    float x;                 /* position                                            [m]      -10000 .. 10000 */
    float vx;                /* velocity along x                                    [m/s]    -1000 .. 1000 */
    float y;                 /* position                                            [m]      -10000 .. 10000 */
    float vy;                /* velocity along y                                    [m/s]    -1000 .. 1000 */
    float z;                 /* altitude, upwards                                   [m]      -10000 .. 10000 */
    float vz;                /* velocity along z                                    [m/s]    -1000 .. 1000 */
    float roll;              /* roll angle, not wrapped                             [rad]    -30 .. 30 */
    float roll_rate;         /* its rate                                            [rad/s]  -100 .. 100 */
    float pitch;             /* pitch angle, not wrapped                            [rad]    -30 .. 30 */
    float pitch_rate;        /* its rate                                            [rad/s]  -100 .. 100 */
    float yaw;               /* yaw angle, not wrapped                              [rad]    -30 .. 30 */
    float yaw_rate;          /* its rate                                            [rad/s]  -100 .. 100 */
    /* factors of the covariance U D U' of the error, upper triangle by rows: D on the diagonal, U beside it */
    float factors[78];       /* 1e-20 .. 1e9; -3.16228e14 .. 3.16228e14 */
    uint32_t rejected_pose;  /* readings of pose gated in a row; stays at its largest value */
} quadrotor_ud_state_t;

typedef struct
{
    float rotor_1;  /* speed of rotor 1  [rad/s]  -1000 .. 1000 */
    float rotor_2;  /* speed of rotor 2  [rad/s]  -1000 .. 1000 */
    float rotor_3;  /* speed of rotor 3  [rad/s]  -1000 .. 1000 */
    float rotor_4;  /* speed of rotor 4  [rad/s]  -1000 .. 1000 */
} quadrotor_ud_predict_in_t;

typedef struct
{
    float pose[6];  /* x, y, z, roll, pitch, yaw  -1e6 .. 1e6 */
} quadrotor_ud_update_pose_in_t;

typedef struct
{
    float innovation[6];  /* measured minus expected */
    float variance[6];    /* of the innovation */
    float nis;            /* normalised innovation squared, of the whole reading */
} quadrotor_ud_update_pose_out_t;

typedef struct
{
    float rotor_1;  /* speed of rotor 1                    [rad/s]  -1000 .. 1000 */
    float rotor_2;  /* speed of rotor 2                    [rad/s]  -1000 .. 1000 */
    float rotor_3;  /* speed of rotor 3                    [rad/s]  -1000 .. 1000 */
    float rotor_4;  /* speed of rotor 4                    [rad/s]  -1000 .. 1000 */
    bool has_pose;  /* whether there is a reading of pose */
    float pose[6];  /* x, y, z, roll, pitch, yaw                    -1e6 .. 1e6 */
} quadrotor_ud_step_in_t;

typedef struct
{
    quadrotor_ud_status_t status_pose;    /* status of pose itself */
    quadrotor_ud_update_pose_out_t pose;  /* what update_pose reported, else zeros */
} quadrotor_ud_step_out_t;

typedef struct
{
    float factor;  /* factor on the covariance  1 .. 1e6 */
} quadrotor_ud_inflate_in_t;

#define QUADROTOR_UD_PARAMS_DEFAULT {1.0e-6f, 1.0e-6f, 1.0e-6f, 1.0e-6f, 1.0e-6f, 1.0e-6f, 1.0e-6f, 1.0e-6f, 1.0e-6f, \
    1.0e-6f, 1.0e-6f, 1.0e-6f, {0.01f, 0.01f, 0.01f, 0.01f, 0.01f, 0.01f}, 0.0f, 0U, 100.0f, 0.0f, 0.0f, 0.0f, 0.0f, \
    30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0033333334f, 0.0033333334f, 0.0033333334f, 0.0033333334f, \
    0.0033333334f, 0.0033333334f, 0.0033333334f, 0.0033333334f, 0.0033333334f, 0.0033333334f, 0.0033333334f, \
    0.0033333334f}

/* Start (or start again) from the initial estimate in the parameters; every parameter is checked here. */
quadrotor_ud_status_t quadrotor_ud_init(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params);

/* Move the estimate one step ahead. */
quadrotor_ud_status_t quadrotor_ud_predict(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                           const quadrotor_ud_predict_in_t *in);

/* Correct the estimate with one reading of pose. `out` is written when the status is not negative. */
quadrotor_ud_status_t quadrotor_ud_update_pose(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                               const quadrotor_ud_update_pose_in_t *in,
                                               quadrotor_ud_update_pose_out_t *out);

/* Predict, then every sensor that has a reading, in this order; a refused sensor is skipped. `out` is written when
 * the status is not negative. */
quadrotor_ud_status_t quadrotor_ud_step(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                        const quadrotor_ud_step_in_t *in, quadrotor_ud_step_out_t *out);

/* Multiply the covariance by a factor and leave the estimate: after a disturbance the model does not know. */
quadrotor_ud_status_t quadrotor_ud_inflate(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                           const quadrotor_ud_inflate_in_t *in);

/* The model this code was written from, for a start-up check against the configuration you flew last. */
const char *quadrotor_ud_model(void);

/* A sentence for a status, for logs. */
const char *quadrotor_ud_status_text(quadrotor_ud_status_t status);

#ifdef __cplusplus
}
#endif

#endif /* QUADROTOR_UD_H */
