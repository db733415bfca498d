/* quadrotor_kf: Kalman filter of the plant "quadrotor" linearised at an operating point, in double precision.
 *
 * Written by plantc 0.1.0 from model 1b4628c2. Do not edit: change the model, export again.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 *
 *    x+ = x + 0.025 vx
 *    vx+ = vx + 0.24525 pitch
 *    y+ = y + 0.025 vy
 *    vy+ = vy + -0.24525 roll
 *    z+ = 30 + z - 30 + 0.025 vz
 *    vz+ = vz + 0.000576466607879 (rotor_1 - 212.718305491) + 0.000576466607879 (rotor_2 - 212.718305491) +
 *         0.000576466607879 (rotor_3 - 212.718305491) + 0.000576466607879 (rotor_4 - 212.718305491)
 *    roll+ = roll + 0.025 roll_rate
 *    roll_rate+ = roll_rate + -0.0170804920853 (rotor_1 - 212.718305491) + -0.0170804920853 (rotor_2 - 212.718305491) +
 *         0.0170804920853 (rotor_3 - 212.718305491) + 0.0170804920853 (rotor_4 - 212.718305491)
 *    pitch+ = pitch + 0.025 pitch_rate
 *    pitch_rate+ = pitch_rate + -0.0170804920853 (rotor_1 - 212.718305491) + 0.0170804920853 (rotor_2 - 212.718305491)
 *         + 0.0170804920853 (rotor_3 - 212.718305491) + -0.0170804920853 (rotor_4 - 212.718305491)
 *    yaw+ = yaw + 0.025 yaw_rate
 *    yaw_rate+ = yaw_rate + 0.000823908929717 (rotor_1 - 212.718305491) + -0.000823908929717 (rotor_2 - 212.718305491)
 *         + 0.000823908929717 (rotor_3 - 212.718305491) + -0.000823908929717 (rotor_4 - 212.718305491)
 *    pose[0] = x + noise
 *    pose[1] = vx + noise
 *    pose[2] = y + noise
 *    pose[3] = vy + noise
 *    pose[4] = z + noise
 *    pose[5] = vz + noise
 *    pose[6] = roll + noise
 *    pose[7] = roll_rate + noise
 *    pose[8] = pitch + noise
 *    pose[9] = pitch_rate + noise
 *    pose[10] = yaw + noise
 *    pose[11] = yaw_rate + noise
 *
 * dt = 0.025 s.
 * Covariance packed (upper triangle by rows); one scalar update for each sensor row.
 * No heap, no globals, no recursion. One state for each instance, used by one context at a time. A call that returns a
 * negative status leaves the state and the outputs exactly as they were. Positive: degraded, the highest is returned.
 * Assumes the FPU rounds to nearest and keeps denormals and NaN (no flush to zero, no default NaN, no -ffast-math).
 */
#ifndef QUADROTOR_KF_H
#define QUADROTOR_KF_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum
{
    QUADROTOR_KF_OK = 0,              /* ok */
    QUADROTOR_KF_GATED = 1,           /* innovation beyond the gate: reading not used */
    QUADROTOR_KF_CLAMPED = 2,         /* a value (a variance, a command) was held at its limit */
    QUADROTOR_KF_SKIPPED = 3,         /* a sensor was refused and skipped: see its own status */
    QUADROTOR_KF_RECOVERED = 4,       /* gated too often in a row: P inflated, reading taken without gate */
    QUADROTOR_KF_BAD_INPUT = -1,      /* an input is outside its range, or not a number */
    QUADROTOR_KF_BAD_PARAM = -2,      /* a parameter is outside its range, or not a number */
    QUADROTOR_KF_NOT_POSITIVE = -3,   /* a variance would not be positive */
    QUADROTOR_KF_OVERFLOW = -4        /* the result would leave its range */
} quadrotor_kf_status_t;

/* What may be tuned without exporting again. Start from QUADROTOR_KF_PARAMS_DEFAULT. */
typedef struct
{
    double variance_step_x;           /* noise per step of x                                 [m^2]        0 .. 1e6 */
    double variance_step_vx;          /* noise per step of vx                                [m^2/s^2]    0 .. 1e6 */
    double variance_step_y;           /* noise per step of y                                 [m^2]        0 .. 1e6 */
    double variance_step_vy;          /* noise per step of vy                                [m^2/s^2]    0 .. 1e6 */
    double variance_step_z;           /* noise per step of z                                 [m^2]        0 .. 1e6 */
    double variance_step_vz;          /* noise per step of vz                                [m^2/s^2]    0 .. 1e6 */
    double variance_step_roll;        /* noise per step of roll                              [rad^2]      0 .. 1e6 */
    double variance_step_roll_rate;   /* noise per step of roll_rate                         [rad^2/s^2]  0 .. 1e6 */
    double variance_step_pitch;       /* noise per step of pitch                             [rad^2]      0 .. 1e6 */
    double variance_step_pitch_rate;  /* noise per step of pitch_rate                        [rad^2/s^2]  0 .. 1e6 */
    double variance_step_yaw;         /* noise per step of yaw                               [rad^2]      0 .. 1e6 */
    double variance_step_yaw_rate;    /* noise per step of yaw_rate                          [rad^2/s^2]  0 .. 1e6 */
    /* noise of pose */
    double variance_pose[12];         /* 1e-12 .. 1e6 */
    double gate_pose;                 /* largest accepted NIS of pose; 0: no gate                         0 .. 1e6 */
    uint32_t reject_limit;            /* readings gated in a row after which step recovers; 0: never */
    double inflation;                 /* factor on P at a recovery                                        1 .. 1e6 */
    /* initial x */
    double x_0;                       /* [m]  -10000 .. 10000 */
    /* initial vx */
    double vx_0;                      /* [m/s]  -1000 .. 1000 */
    /* initial y */
    double y_0;                       /* [m]  -10000 .. 10000 */
    /* initial vy */
    double vy_0;                      /* [m/s]  -1000 .. 1000 */
    /* initial z */
    double z_0;                       /* [m]  -10000 .. 10000 */
    /* initial vz */
    double vz_0;                      /* [m/s]  -1000 .. 1000 */
    double roll_0;                    /* initial roll                                        [rad]        -30 .. 30 */
    double roll_rate_0;               /* initial roll_rate                                   [rad/s]      -100 .. 100 */
    double pitch_0;                   /* initial pitch                                       [rad]        -30 .. 30 */
    double pitch_rate_0;              /* initial pitch_rate                                  [rad/s]      -100 .. 100 */
    double yaw_0;                     /* initial yaw                                         [rad]        -30 .. 30 */
    double yaw_rate_0;                /* initial yaw_rate                                    [rad/s]      -100 .. 100 */
    /* variance of the error of x_0 */
    double variance_x_0;              /* [m^2]  1e-12 .. 1e6 */
    /* variance of the error of vx_0 */
    double variance_vx_0;             /* [m^2/s^2]  1e-12 .. 1e6 */
    /* variance of the error of y_0 */
    double variance_y_0;              /* [m^2]  1e-12 .. 1e6 */
    /* variance of the error of vy_0 */
    double variance_vy_0;             /* [m^2/s^2]  1e-12 .. 1e6 */
    /* variance of the error of z_0 */
    double variance_z_0;              /* [m^2]  1e-12 .. 1e6 */
    /* variance of the error of vz_0 */
    double variance_vz_0;             /* [m^2/s^2]  1e-12 .. 1e6 */
    /* variance of the error of roll_0 */
    double variance_roll_0;           /* [rad^2]  1e-12 .. 1e6 */
    /* variance of the error of roll_rate_0 */
    double variance_roll_rate_0;      /* [rad^2/s^2]  1e-12 .. 1e6 */
    /* variance of the error of pitch_0 */
    double variance_pitch_0;          /* [rad^2]  1e-12 .. 1e6 */
    /* variance of the error of pitch_rate_0 */
    double variance_pitch_rate_0;     /* [rad^2/s^2]  1e-12 .. 1e6 */
    /* variance of the error of yaw_0 */
    double variance_yaw_0;            /* [rad^2]  1e-12 .. 1e6 */
    /* variance of the error of yaw_rate_0 */
    double variance_yaw_rate_0;       /* [rad^2/s^2]  1e-12 .. 1e6 */
} quadrotor_kf_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    double x;                /* position                                            [m]      -10000 .. 10000 */
    double vx;               /* velocity along x                                    [m/s]    -1000 .. 1000 */
    double y;                /* position                                            [m]      -10000 .. 10000 */
    double vy;               /* velocity along y                                    [m/s]    -1000 .. 1000 */
    double z;                /* altitude, upwards                                   [m]      -10000 .. 10000 */
    double vz;               /* velocity along z                                    [m/s]    -1000 .. 1000 */
    double roll;             /* roll angle, not wrapped                             [rad]    -30 .. 30 */
    double roll_rate;        /* its rate                                            [rad/s]  -100 .. 100 */
    double pitch;            /* pitch angle, not wrapped                            [rad]    -30 .. 30 */
    double pitch_rate;       /* its rate                                            [rad/s]  -100 .. 100 */
    double yaw;              /* yaw angle, not wrapped                              [rad]    -30 .. 30 */
    double yaw_rate;         /* its rate                                            [rad/s]  -100 .. 100 */
    /* covariance of the error, upper triangle by rows */
    double covariance[78];   /* 1e-20 .. 1e9; -1e9 .. 1e9 */
    uint32_t rejected_pose;  /* readings of pose gated in a row; stays at its largest value */
} quadrotor_kf_state_t;

typedef struct
{
    double rotor_1;  /* speed of rotor 1  [rad/s]  -1000 .. 1000 */
    double rotor_2;  /* speed of rotor 2  [rad/s]  -1000 .. 1000 */
    double rotor_3;  /* speed of rotor 3  [rad/s]  -1000 .. 1000 */
    double rotor_4;  /* speed of rotor 4  [rad/s]  -1000 .. 1000 */
} quadrotor_kf_predict_in_t;

typedef struct
{
    double pose[12];  /* all twelve states, in their order  -1e6 .. 1e6 */
} quadrotor_kf_update_pose_in_t;

typedef struct
{
    double innovation[12];  /* measured minus expected */
    double variance[12];    /* of the innovation */
    double nis;             /* normalised innovation squared, of the whole reading */
} quadrotor_kf_update_pose_out_t;

typedef struct
{
    double rotor_1;   /* speed of rotor 1                    [rad/s]  -1000 .. 1000 */
    double rotor_2;   /* speed of rotor 2                    [rad/s]  -1000 .. 1000 */
    double rotor_3;   /* speed of rotor 3                    [rad/s]  -1000 .. 1000 */
    double rotor_4;   /* speed of rotor 4                    [rad/s]  -1000 .. 1000 */
    bool has_pose;    /* whether there is a reading of pose */
    double pose[12];  /* all twelve states, in their order            -1e6 .. 1e6 */
} quadrotor_kf_step_in_t;

typedef struct
{
    quadrotor_kf_status_t status_pose;    /* status of pose itself */
    quadrotor_kf_update_pose_out_t pose;  /* what update_pose reported, else zeros */
} quadrotor_kf_step_out_t;

typedef struct
{
    double factor;  /* factor on the covariance  1 .. 1e6 */
} quadrotor_kf_inflate_in_t;

#define QUADROTOR_KF_PARAMS_DEFAULT {1.0e-6, 1.0e-6, 1.0e-6, 1.0e-6, 1.0e-6, 1.0e-6, 1.0e-6, 1.0e-6, 1.0e-6, 1.0e-6, \
    1.0e-6, 1.0e-6, {0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01}, 0.0, 0U, 100.0, 0.0, \
    0.0, 0.0, 0.0, 30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0033333333333333335, 0.0033333333333333335, \
    0.0033333333333333335, 0.0033333333333333335, 0.0033333333333333335, 0.0033333333333333335, 0.0033333333333333335, \
    0.0033333333333333335, 0.0033333333333333335, 0.0033333333333333335, 0.0033333333333333335, 0.0033333333333333335}

/* Start (or start again) from the initial estimate in the parameters; every parameter is checked here. */
quadrotor_kf_status_t quadrotor_kf_init(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params);

/* Move the estimate one step ahead. */
quadrotor_kf_status_t quadrotor_kf_predict(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                           const quadrotor_kf_predict_in_t *in);

/* Correct the estimate with one reading of pose. `out` is written when the status is not negative. */
quadrotor_kf_status_t quadrotor_kf_update_pose(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                               const quadrotor_kf_update_pose_in_t *in,
                                               quadrotor_kf_update_pose_out_t *out);

/* Predict, then every sensor that has a reading, in this order; a refused sensor is skipped. `out` is written when
 * the status is not negative. */
quadrotor_kf_status_t quadrotor_kf_step(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                        const quadrotor_kf_step_in_t *in, quadrotor_kf_step_out_t *out);

/* Multiply the covariance by a factor and leave the estimate: after a disturbance the model does not know. */
quadrotor_kf_status_t quadrotor_kf_inflate(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                           const quadrotor_kf_inflate_in_t *in);

/* The model this code was written from, for a start-up check against the configuration you flew last. */
const char *quadrotor_kf_model(void);

/* A sentence for a status, for logs. */
const char *quadrotor_kf_status_text(quadrotor_kf_status_t status);

#ifdef __cplusplus
}
#endif

#endif /* QUADROTOR_KF_H */
