/* quadrotor_jsse_controller: composition of quadrotor_jsse, feedback, in single precision.
 *
 * Written by plantc 0.1.0 from model 3848e263. Do not edit: change the model, export again.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 *
 *    estimator: x' = vx
 *    estimator: vx' = (sin(yaw) sin(roll) + cos(yaw) sin(pitch)) cos(roll) (thrust_factor (rotor_1^2 + rotor_2^2 +
 *         rotor_3^2 + rotor_4^2) / mass)
 *    estimator: y' = vy
 *    estimator: vy' = (sin(yaw) sin(pitch) - cos(yaw) sin(roll)) cos(roll) (thrust_factor (rotor_1^2 + rotor_2^2 +
 *         rotor_3^2 + rotor_4^2) / mass)
 *    estimator: z' = vz
 *    estimator: vz' = cos(pitch) cos(roll) (thrust_factor (rotor_1^2 + rotor_2^2 + rotor_3^2 + rotor_4^2) / mass) -
 *         gravity
 *    estimator: roll' = roll_rate
 *    estimator: roll_rate' = pitch_rate yaw_rate ((inertia_y - inertia_z) / inertia_x) - (inertia_rotor / inertia_x)
 *         pitch_rate (rotor_1 - rotor_2 + rotor_3 - rotor_4) + (arm_length / inertia_x) (thrust_factor (rotor_3^2 -
 *         (rotor_1^2 + rotor_2^2) + rotor_4^2))
 *    estimator: pitch' = pitch_rate
 *    estimator: pitch_rate' = roll_rate yaw_rate ((inertia_z - inertia_x) / inertia_y) + (inertia_rotor / inertia_y)
 *         roll_rate (rotor_1 - rotor_2 + rotor_3 - rotor_4) + (arm_length / inertia_y) (thrust_factor (rotor_2^2 -
 *         rotor_1^2 + rotor_3^2 - rotor_4^2))
 *    estimator: yaw' = yaw_rate
 *    estimator: yaw_rate' = roll_rate pitch_rate ((inertia_x - inertia_y) / inertia_z) + drag_factor (rotor_1^2 -
 *         rotor_2^2 + rotor_3^2 - rotor_4^2) / inertia_z
 *    estimator: pose[0] = x + noise
 *    estimator: pose[1] = vx + noise
 *    estimator: pose[2] = y + noise
 *    estimator: pose[3] = vy + noise
 *    estimator: pose[4] = z + noise
 *    estimator: pose[5] = vz + noise
 *    estimator: pose[6] = roll + noise
 *    estimator: pose[7] = roll_rate + noise
 *    estimator: pose[8] = pitch + noise
 *    estimator: pose[9] = pitch_rate + noise
 *    estimator: pose[10] = yaw + noise
 *    estimator: pose[11] = yaw_rate + noise
 *    feedback: step: rotor_1 = rotor_1 - (gain[0] (x - params.x) + gain[1] (vx - params.vx) + gain[2] (y - params.y) +
 *         gain[3] (vy - params.vy) + gain[4] (z - params.z) + gain[5] (vz - params.vz) + gain[6] (roll - params.roll) +
 *         gain[7] (roll_rate - params.roll_rate) + gain[8] (pitch - params.pitch) + gain[9] (pitch_rate -
 *         params.pitch_rate) + gain[10] (yaw - params.yaw) + gain[11] (yaw_rate - params.yaw_rate))
 *    feedback: step: rotor_2 = rotor_2 - (gain[12] (x - params.x) + gain[13] (vx - params.vx) + gain[14] (y - params.y)
 *         + gain[15] (vy - params.vy) + gain[16] (z - params.z) + gain[17] (vz - params.vz) + gain[18] (roll -
 *         params.roll) + gain[19] (roll_rate - params.roll_rate) + gain[20] (pitch - params.pitch) + gain[21]
 *         (pitch_rate - params.pitch_rate) + gain[22] (yaw - params.yaw) + gain[23] (yaw_rate - params.yaw_rate))
 *    feedback: step: rotor_3 = rotor_3 - (gain[24] (x - params.x) + gain[25] (vx - params.vx) + gain[26] (y - params.y)
 *         + gain[27] (vy - params.vy) + gain[28] (z - params.z) + gain[29] (vz - params.vz) + gain[30] (roll -
 *         params.roll) + gain[31] (roll_rate - params.roll_rate) + gain[32] (pitch - params.pitch) + gain[33]
 *         (pitch_rate - params.pitch_rate) + gain[34] (yaw - params.yaw) + gain[35] (yaw_rate - params.yaw_rate))
 *    feedback: step: rotor_4 = rotor_4 - (gain[36] (x - params.x) + gain[37] (vx - params.vx) + gain[38] (y - params.y)
 *         + gain[39] (vy - params.vy) + gain[40] (z - params.z) + gain[41] (vz - params.vz) + gain[42] (roll -
 *         params.roll) + gain[43] (roll_rate - params.roll_rate) + gain[44] (pitch - params.pitch) + gain[45]
 *         (pitch_rate - params.pitch_rate) + gain[46] (yaw - params.yaw) + gain[47] (yaw_rate - params.yaw_rate))
 *
 * feedback.x = estimator.x
 * feedback.vx = estimator.vx
 * feedback.y = estimator.y
 * feedback.vy = estimator.vy
 * feedback.z = estimator.z
 * feedback.vz = estimator.vz
 * feedback.roll = estimator.roll
 * feedback.roll_rate = estimator.roll_rate
 * feedback.pitch = estimator.pitch
 * feedback.pitch_rate = estimator.pitch_rate
 * feedback.yaw = estimator.yaw
 * feedback.yaw_rate = estimator.yaw_rate
 * estimator.rotor_1 = feedback.rotor_1, one step late
 * estimator.rotor_2 = feedback.rotor_2, one step late
 * estimator.rotor_3 = feedback.rotor_3, one step late
 * estimator.rotor_4 = feedback.rotor_4, one step late
 * Mathematics: plantc's own, in the source; largest errors: cos (1.5 ulp), sin (1.5 ulp). The same bits on every
 * machine if built with -ffp-contract=off.
 * No heap, no globals, no recursion. One state for each instance, used by one context at a time. A call that returns a
 * negative status leaves the state and the outputs exactly as they were. Positive: degraded, the highest is returned.
 * Assumes the FPU rounds to nearest and keeps denormals and NaN (no flush to zero, no default NaN, no -ffast-math).
 */
#ifndef QUADROTOR_JSSE_CONTROLLER_H
#define QUADROTOR_JSSE_CONTROLLER_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum
{
    QUADROTOR_JSSE_CONTROLLER_OK = 0,              /* ok */
    QUADROTOR_JSSE_CONTROLLER_GATED = 1,           /* innovation beyond the gate: reading not used */
    QUADROTOR_JSSE_CONTROLLER_CLAMPED = 2,         /* a value (a variance, a command) was held at its limit */
    QUADROTOR_JSSE_CONTROLLER_SKIPPED = 3,         /* a sensor was refused and skipped: see its own status */
    QUADROTOR_JSSE_CONTROLLER_RECOVERED = 4,       /* gated too often in a row: P inflated, reading taken without gate */
    QUADROTOR_JSSE_CONTROLLER_BAD_INPUT = -1,      /* an input is outside its range, or not a number */
    QUADROTOR_JSSE_CONTROLLER_BAD_PARAM = -2,      /* a parameter is outside its range, or not a number */
    QUADROTOR_JSSE_CONTROLLER_NOT_POSITIVE = -3,   /* a variance would not be positive */
    QUADROTOR_JSSE_CONTROLLER_OVERFLOW = -4        /* the result would leave its range */
} quadrotor_jsse_controller_status_t;

/* What may be tuned without exporting again. */
typedef struct
{
    float std_pose;      /* standard deviation r of the noise of pose           0 .. 1e6 */
    float x_0;           /* initial x                                  [m]      -10000 .. 10000 */
    float vx_0;          /* initial vx                                 [m/s]    -1000 .. 1000 */
    float y_0;           /* initial y                                  [m]      -10000 .. 10000 */
    float vy_0;          /* initial vy                                 [m/s]    -1000 .. 1000 */
    float z_0;           /* initial z                                  [m]      -10000 .. 10000 */
    float vz_0;          /* initial vz                                 [m/s]    -1000 .. 1000 */
    float roll_0;        /* initial roll                               [rad]    -30 .. 30 */
    float roll_rate_0;   /* initial roll_rate                          [rad/s]  -100 .. 100 */
    float pitch_0;       /* initial pitch                              [rad]    -30 .. 30 */
    float pitch_rate_0;  /* initial pitch_rate                         [rad/s]  -100 .. 100 */
    float yaw_0;         /* initial yaw                                [rad]    -30 .. 30 */
    float yaw_rate_0;    /* initial yaw_rate                           [rad/s]  -100 .. 100 */
} quadrotor_jsse_controller_estimator_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    float x;           /* position                  [m]      -10000 .. 10000 */
    float vx;          /* velocity along x          [m/s]    -1000 .. 1000 */
    float y;           /* position                  [m]      -10000 .. 10000 */
    float vy;          /* velocity along y          [m/s]    -1000 .. 1000 */
    float z;           /* altitude, upwards         [m]      -10000 .. 10000 */
    float vz;          /* velocity along z          [m/s]    -1000 .. 1000 */
    float roll;        /* roll angle, not wrapped   [rad]    -30 .. 30 */
    float roll_rate;   /* its rate                  [rad/s]  -100 .. 100 */
    float pitch;       /* pitch angle, not wrapped  [rad]    -30 .. 30 */
    float pitch_rate;  /* its rate                  [rad/s]  -100 .. 100 */
    float yaw;         /* yaw angle, not wrapped    [rad]    -30 .. 30 */
    float yaw_rate;    /* its rate                  [rad/s]  -100 .. 100 */
} quadrotor_jsse_controller_estimator_state_t;

typedef struct
{
    float innovation[12];    /* measured minus expected */
    float distance_squared;  /* D2, of the reading from the prediction */
    float weight;            /* of the reading: 1 takes what it says, 0 leaves the prediction  0 .. 1 */
} quadrotor_jsse_controller_estimator_update_pose_out_t;

typedef struct
{
    quadrotor_jsse_controller_status_t status_pose;              /* status of pose itself */
    quadrotor_jsse_controller_estimator_update_pose_out_t pose;  /* what update_pose reported, else zeros */
} quadrotor_jsse_controller_estimator_step_out_t;

/* What may be tuned without exporting again. */
typedef struct
{
    float x;           /* set point of x                                      [m]      -10000 .. 10000 */
    float vx;          /* set point of vx                                     [m/s]    -1000 .. 1000 */
    float y;           /* set point of y                                      [m]      -10000 .. 10000 */
    float vy;          /* set point of vy                                     [m/s]    -1000 .. 1000 */
    float z;           /* set point of z                                      [m]      -10000 .. 10000 */
    float vz;          /* set point of vz                                     [m/s]    -1000 .. 1000 */
    float roll;        /* set point of roll                                   [rad]    -30 .. 30 */
    float roll_rate;   /* set point of roll_rate                              [rad/s]  -100 .. 100 */
    float pitch;       /* set point of pitch                                  [rad]    -30 .. 30 */
    float pitch_rate;  /* set point of pitch_rate                             [rad/s]  -100 .. 100 */
    float yaw;         /* set point of yaw                                    [rad]    -30 .. 30 */
    float yaw_rate;    /* set point of yaw_rate                               [rad/s]  -100 .. 100 */
    float rotor_1;     /* rotor_1 that holds the set point                    [rad/s]  -1000 .. 1000 */
    float rotor_2;     /* rotor_2 that holds the set point                    [rad/s]  -1000 .. 1000 */
    float rotor_3;     /* rotor_3 that holds the set point                    [rad/s]  -1000 .. 1000 */
    float rotor_4;     /* rotor_4 that holds the set point                    [rad/s]  -1000 .. 1000 */
    /* K by rows (rotor_1, rotor_2, rotor_3, rotor_4), columns in the order of the states */
    float gain[48];    /* -1e6 .. 1e6 */
} quadrotor_jsse_controller_feedback_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    uint8_t unused;  /* nothing to remember */
} quadrotor_jsse_controller_feedback_state_t;

typedef struct
{
    float rotor_1;  /* speed of rotor 1; keeps its last value when a call is refused  [rad/s]  -1000 .. 1000 */
    float rotor_2;  /* speed of rotor 2; keeps its last value when a call is refused  [rad/s]  -1000 .. 1000 */
    float rotor_3;  /* speed of rotor 3; keeps its last value when a call is refused  [rad/s]  -1000 .. 1000 */
    float rotor_4;  /* speed of rotor 4; keeps its last value when a call is refused  [rad/s]  -1000 .. 1000 */
} quadrotor_jsse_controller_feedback_step_out_t;

/* What may be tuned without exporting again. Start from QUADROTOR_JSSE_CONTROLLER_PARAMS_DEFAULT. */
typedef struct
{
    float delay_estimator_rotor_1_0;                         /* first estimator.rotor_1  [rad/s]  -1000 .. 1000 */
    float delay_estimator_rotor_2_0;                         /* first estimator.rotor_2  [rad/s]  -1000 .. 1000 */
    float delay_estimator_rotor_3_0;                         /* first estimator.rotor_3  [rad/s]  -1000 .. 1000 */
    float delay_estimator_rotor_4_0;                         /* first estimator.rotor_4  [rad/s]  -1000 .. 1000 */
    quadrotor_jsse_controller_estimator_params_t estimator;
    quadrotor_jsse_controller_feedback_params_t feedback;
} quadrotor_jsse_controller_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    /* estimator.rotor_1 of the next step */
    float delay_estimator_rotor_1;                          /* [rad/s]  -1000 .. 1000 */
    /* estimator.rotor_2 of the next step */
    float delay_estimator_rotor_2;                          /* [rad/s]  -1000 .. 1000 */
    /* estimator.rotor_3 of the next step */
    float delay_estimator_rotor_3;                          /* [rad/s]  -1000 .. 1000 */
    /* estimator.rotor_4 of the next step */
    float delay_estimator_rotor_4;                          /* [rad/s]  -1000 .. 1000 */
    quadrotor_jsse_controller_estimator_state_t estimator;
    quadrotor_jsse_controller_feedback_state_t feedback;
} quadrotor_jsse_controller_state_t;

typedef struct
{
    bool estimator_has_pose;   /* whether there is a reading of pose */
    float estimator_pose[12];  /* all twelve states, in their order   -1e6 .. 1e6 */
} quadrotor_jsse_controller_step_in_t;

typedef struct
{
    quadrotor_jsse_controller_estimator_step_out_t estimator;  /* what estimator gave */
    quadrotor_jsse_controller_feedback_step_out_t feedback;    /* what feedback gave */
} quadrotor_jsse_controller_step_out_t;

#define QUADROTOR_JSSE_CONTROLLER_PARAMS_DEFAULT {212.7183f, 212.7183f, 212.7183f, 212.7183f, {0.1f, 0.0f, 0.0f, 0.0f, \
    0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, \
    0.0f, 0.0f, 0.0f, 212.7183f, 212.7183f, 212.7183f, 212.7183f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, \
    711.0f, 56.0f, 28.0f, 3.4f, 177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, \
    71.0f, -188.0f, -76.0f, -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, \
    399.0f, 311.0f, -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}}

/* Start (or start again) from the parameters; every parameter is checked here. */
quadrotor_jsse_controller_status_t quadrotor_jsse_controller_init(quadrotor_jsse_controller_state_t *state,
                                                                  const quadrotor_jsse_controller_params_t *params);

/* Call estimator, then feedback. `out` is written when the status is not negative. */
quadrotor_jsse_controller_status_t quadrotor_jsse_controller_step(quadrotor_jsse_controller_state_t *state,
                                                                  const quadrotor_jsse_controller_params_t *params,
                                                                  const quadrotor_jsse_controller_step_in_t *in,
                                                                  quadrotor_jsse_controller_step_out_t *out);

/* The model this code was written from, for a start-up check against the configuration you flew last. */
const char *quadrotor_jsse_controller_model(void);

/* A sentence for a status, for logs. */
const char *quadrotor_jsse_controller_status_text(quadrotor_jsse_controller_status_t status);

#ifdef __cplusplus
}
#endif

#endif /* QUADROTOR_JSSE_CONTROLLER_H */
