/* quadrotor_together_regulator: output regulator of the plant "quadrotor": follows x, y, z, yaw, in single precision.
 *
 * Written by plantc 0.1.0 from model 1eed9805. Do not edit: change the model, export again.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 *
 *    generator: w_x[0]+ = w_x[0] + 0.02 w_x[1]
 *    generator: w_x[1]+ = w_x[1] + 0.02 w_x[2]
 *    generator: w_x[2]+ = w_x[2] + 0.02 w_x[3]
 *    generator: w_x[3]+ = w_x[3] + 0.02 w_x[4]
 *    generator: w_x[4]+ = w_x[4] + 0.02 w_x[5]
 *    generator: w_x[5]+ = w_x[5] + 0.02 w_x[6]
 *    generator: w_x[6]+ = w_x[6]
 *    generator: w_y[0]+ = w_y[0] + 0.02 w_y[1]
 *    generator: w_y[1]+ = w_y[1] + 0.02 w_y[2]
 *    generator: w_y[2]+ = w_y[2] + 0.02 w_y[3]
 *    generator: w_y[3]+ = w_y[3] + 0.02 w_y[4]
 *    generator: w_y[4]+ = w_y[4] + 0.02 w_y[5]
 *    generator: w_y[5]+ = w_y[5] + 0.02 w_y[6]
 *    generator: w_y[6]+ = w_y[6]
 *    generator: w_z[0]+ = w_z[0] + 0.02 w_z[1]
 *    generator: w_z[1]+ = w_z[1] + 0.02 w_z[2]
 *    generator: w_z[2]+ = w_z[2] + 0.02 w_z[3]
 *    generator: w_z[3]+ = w_z[3] + 0.02 w_z[4]
 *    generator: w_z[4]+ = w_z[4] + 0.02 w_z[5]
 *    generator: w_z[5]+ = w_z[5] + 0.02 w_z[6]
 *    generator: w_z[6]+ = w_z[6]
 *    generator: w_yaw[0]+ = w_yaw[0] + 0.02 w_yaw[1]
 *    generator: w_yaw[1]+ = w_yaw[1] + 0.02 w_yaw[2]
 *    generator: w_yaw[2]+ = w_yaw[2] + 0.02 w_yaw[3]
 *    generator: w_yaw[3]+ = w_yaw[3] + 0.02 w_yaw[4]
 *    generator: w_yaw[4]+ = w_yaw[4] + 0.02 w_yaw[5]
 *    generator: w_yaw[5]+ = w_yaw[5] + 0.02 w_yaw[6]
 *    generator: w_yaw[6]+ = w_yaw[6]
 *    generator: readings[0] = w_x[0] + noise
 *    generator: readings[1] = w_y[0] + noise
 *    generator: readings[2] = w_z[0] + noise
 *    generator: readings[3] = w_yaw[0] + noise
 *    feedback: step: rotor_1 = rotor_1 + -0.0373001546 w_x[4] + 0.0373001546 w_y[4] + 10.8419116 w_z[2] + 7.58578985
 *         w_yaw[2] - (-4.13564904 (x - params.x - w_x[0]) + -6.44956949 (vx - params.vx - w_x[1]) + 4.13564904 (y -
 *         params.y - w_y[0]) + 6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171
 *         (vz - params.vz - w_z[1]) + -28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + -6.32217889 (roll_rate -
 *         params.roll_rate - -0.101936799 w_y[3]) + -28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) +
 *         -6.32217889 (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + 4.93424116 (yaw - params.yaw - w_yaw[0])
 *         + 10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1]))
 *    feedback: step: rotor_2 = rotor_2 + 0.0373001546 w_x[4] + 0.0373001546 w_y[4] + 10.8419116 w_z[2] + -7.58578985
 *         w_yaw[2] - (4.13564904 (x - params.x - w_x[0]) + 6.44956949 (vx - params.vx - w_x[1]) + 4.13564904 (y -
 *         params.y - w_y[0]) + 6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171
 *         (vz - params.vz - w_z[1]) + -28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + -6.32217889 (roll_rate -
 *         params.roll_rate - -0.101936799 w_y[3]) + 28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) + 6.32217889
 *         (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + -4.93424116 (yaw - params.yaw - w_yaw[0]) +
 *         -10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1]))
 *    feedback: step: rotor_3 = rotor_3 + 0.0373001546 w_x[4] + -0.0373001546 w_y[4] + 10.8419116 w_z[2] + 7.58578985
 *         w_yaw[2] - (4.13564904 (x - params.x - w_x[0]) + 6.44956949 (vx - params.vx - w_x[1]) + -4.13564904 (y -
 *         params.y - w_y[0]) + -6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171
 *         (vz - params.vz - w_z[1]) + 28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + 6.32217889 (roll_rate -
 *         params.roll_rate - -0.101936799 w_y[3]) + 28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) + 6.32217889
 *         (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + 4.93424116 (yaw - params.yaw - w_yaw[0]) + 10.0097342
 *         (yaw_rate - params.yaw_rate - w_yaw[1]))
 *    feedback: step: rotor_4 = rotor_4 + -0.0373001546 w_x[4] + -0.0373001546 w_y[4] + 10.8419116 w_z[2] + -7.58578985
 *         w_yaw[2] - (-4.13564904 (x - params.x - w_x[0]) + -6.44956949 (vx - params.vx - w_x[1]) + -4.13564904 (y -
 *         params.y - w_y[0]) + -6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171
 *         (vz - params.vz - w_z[1]) + 28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + 6.32217889 (roll_rate -
 *         params.roll_rate - -0.101936799 w_y[3]) + -28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) +
 *         -6.32217889 (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + -4.93424116 (yaw - params.yaw - w_yaw[0])
 *         + -10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1]))
 *
 * feedback.w_x = generator.w_x
 * feedback.w_y = generator.w_y
 * feedback.w_z = generator.w_z
 * feedback.w_yaw = generator.w_yaw
 * No heap, no globals, no recursion. One state for each instance, used by one context at a time. A call that returns a
 * negative status leaves the state and the outputs exactly as they were. Positive: degraded, the highest is returned.
 * Assumes the FPU rounds to nearest and keeps denormals and NaN (no flush to zero, no default NaN, no -ffast-math).
 */
#ifndef QUADROTOR_TOGETHER_REGULATOR_H
#define QUADROTOR_TOGETHER_REGULATOR_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum
{
    QUADROTOR_TOGETHER_REGULATOR_OK = 0,              /* ok */
    QUADROTOR_TOGETHER_REGULATOR_GATED = 1,           /* innovation beyond the gate: reading not used */
    QUADROTOR_TOGETHER_REGULATOR_CLAMPED = 2,         /* a value (a variance, a command) was held at its limit */
    QUADROTOR_TOGETHER_REGULATOR_SKIPPED = 3,         /* a sensor was refused and skipped: see its own status */
    QUADROTOR_TOGETHER_REGULATOR_RECOVERED = 4,       /* gated too often in a row: P inflated, reading taken without gate */
    QUADROTOR_TOGETHER_REGULATOR_BAD_INPUT = -1,      /* an input is outside its range, or not a number */
    QUADROTOR_TOGETHER_REGULATOR_BAD_PARAM = -2,      /* a parameter is outside its range, or not a number */
    QUADROTOR_TOGETHER_REGULATOR_NOT_POSITIVE = -3,   /* a variance would not be positive */
    QUADROTOR_TOGETHER_REGULATOR_OVERFLOW = -4        /* the result would leave its range */
} quadrotor_together_regulator_status_t;

/* What may be tuned without exporting again. */
typedef struct
{
    float variance_step[7];   /* noise per step of w, of each signal alike           0 .. 1e6 */
    float variance_readings;  /* noise of each reading                               1e-12 .. 1e6 */
    float gate_readings;      /* largest accepted NIS of readings; 0: no gate        0 .. 1e6 */
    uint32_t reject_limit;    /* readings gated in a row after which step recovers; 0: never */
    float inflation;          /* factor on P at a recovery                           1 .. 1e6 */
    float variance_0[7];      /* variance of the error of every w_0, of each signal alike  1e-12 .. 1e6 */
} quadrotor_together_regulator_generator_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    float w_x[7];                /* generates x                                         -1e6 .. 1e6 */
    float w_y[7];                /* generates y                                         -1e6 .. 1e6 */
    float w_z[7];                /* generates z                                         -1e6 .. 1e6 */
    float w_yaw[7];              /* generates yaw                                       -1e6 .. 1e6 */
    float covariance[28];        /* covariance of the error, upper triangle by rows     1e-20 .. 1e9; -1e9 .. 1e9 */
    uint32_t rejected_readings;  /* readings of readings gated in a row; stays at its largest value */
} quadrotor_together_regulator_generator_state_t;

typedef struct
{
    float innovation[4];  /* measured minus expected */
    float variance;       /* of the innovation, of each reading */
    float nis;            /* normalised innovation squared, of the whole reading */
} quadrotor_together_regulator_generator_update_readings_out_t;

typedef struct
{
    quadrotor_together_regulator_status_t status_readings;                  /* status of readings itself */
    /* what update_readings reported, else zeros */
    quadrotor_together_regulator_generator_update_readings_out_t readings;
} quadrotor_together_regulator_generator_step_out_t;

/* What may be tuned without exporting again. */
typedef struct
{
    float x;           /* set point of x                     [m]      -10000 .. 10000 */
    float vx;          /* set point of vx                    [m/s]    -10000 .. 10000 */
    float y;           /* set point of y                     [m]      -10000 .. 10000 */
    float vy;          /* set point of vy                    [m/s]    -10000 .. 10000 */
    float z;           /* set point of z                     [m]      -10000 .. 10000 */
    float vz;          /* set point of vz                    [m/s]    -10000 .. 10000 */
    float roll;        /* set point of roll                  [rad]    -30 .. 30 */
    float roll_rate;   /* set point of roll_rate             [rad/s]  -1000 .. 1000 */
    float pitch;       /* set point of pitch                 [rad]    -30 .. 30 */
    float pitch_rate;  /* set point of pitch_rate            [rad/s]  -1000 .. 1000 */
    float yaw;         /* set point of yaw                   [rad]    -30 .. 30 */
    float yaw_rate;    /* set point of yaw_rate              [rad/s]  -1000 .. 1000 */
    float rotor_1;     /* what holds the set point: rotor_1  [rad/s]  -10000 .. 10000 */
    float rotor_2;     /* what holds the set point: rotor_2  [rad/s]  -10000 .. 10000 */
    float rotor_3;     /* what holds the set point: rotor_3  [rad/s]  -10000 .. 10000 */
    float rotor_4;     /* what holds the set point: rotor_4  [rad/s]  -10000 .. 10000 */
} quadrotor_together_regulator_feedback_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    uint8_t unused;  /* nothing to remember */
} quadrotor_together_regulator_feedback_state_t;

typedef struct
{
    float rotor_1;  /* speed of rotor 1; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
    float rotor_2;  /* speed of rotor 2; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
    float rotor_3;  /* speed of rotor 3; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
    float rotor_4;  /* speed of rotor 4; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
} quadrotor_together_regulator_feedback_step_out_t;

/* What may be tuned without exporting again. Start from QUADROTOR_TOGETHER_REGULATOR_PARAMS_DEFAULT. */
typedef struct
{
    quadrotor_together_regulator_generator_params_t generator;
    quadrotor_together_regulator_feedback_params_t feedback;
} quadrotor_together_regulator_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    quadrotor_together_regulator_generator_state_t generator;
    quadrotor_together_regulator_feedback_state_t feedback;
} quadrotor_together_regulator_state_t;

typedef struct
{
    bool generator_has_readings;  /* whether there is a reading of readings */
    float generator_readings[4];  /* readings of x, y, z, yaw                         -10 .. 10 */
    float feedback_x;             /* position                                [m]      -10000 .. 10000 */
    float feedback_vx;            /* velocity along x                        [m/s]    -10000 .. 10000 */
    float feedback_y;             /* position                                [m]      -10000 .. 10000 */
    float feedback_vy;            /* velocity along y                        [m/s]    -10000 .. 10000 */
    float feedback_z;             /* altitude, upwards                       [m]      -10000 .. 10000 */
    float feedback_vz;            /* velocity along z                        [m/s]    -10000 .. 10000 */
    float feedback_roll;          /* roll angle, not wrapped                 [rad]    -30 .. 30 */
    float feedback_roll_rate;     /* its rate                                [rad/s]  -1000 .. 1000 */
    float feedback_pitch;         /* pitch angle, not wrapped                [rad]    -30 .. 30 */
    float feedback_pitch_rate;    /* its rate                                [rad/s]  -1000 .. 1000 */
    float feedback_yaw;           /* yaw angle, not wrapped                  [rad]    -30 .. 30 */
    float feedback_yaw_rate;      /* its rate                                [rad/s]  -1000 .. 1000 */
} quadrotor_together_regulator_step_in_t;

typedef struct
{
    quadrotor_together_regulator_generator_step_out_t generator;  /* what generator gave */
    quadrotor_together_regulator_feedback_step_out_t feedback;    /* what feedback gave */
} quadrotor_together_regulator_step_out_t;

#define QUADROTOR_TOGETHER_REGULATOR_PARAMS_DEFAULT {{{1.0e-12f, 1.0e-12f, 1.0e-12f, 1.0e-12f, 1.0e-12f, 1.0e-12f, \
    1.0e-12f}, 0.01f, 0.0f, 0U, 100.0f, {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, \
    0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.7183f, 212.7183f, 212.7183f, 212.7183f}}

/* Start (or start again) from the parameters; every parameter is checked here. */
quadrotor_together_regulator_status_t quadrotor_together_regulator_init(
    quadrotor_together_regulator_state_t *state, const quadrotor_together_regulator_params_t *params);

/* Call generator, then feedback. `out` is written when the status is not negative. */
quadrotor_together_regulator_status_t quadrotor_together_regulator_step(
    quadrotor_together_regulator_state_t *state, const quadrotor_together_regulator_params_t *params,
    const quadrotor_together_regulator_step_in_t *in, quadrotor_together_regulator_step_out_t *out);

/* The model this code was written from, for a start-up check against the configuration you flew last. */
const char *quadrotor_together_regulator_model(void);

/* A sentence for a status, for logs. */
const char *quadrotor_together_regulator_status_text(quadrotor_together_regulator_status_t status);

#ifdef __cplusplus
}
#endif

#endif /* QUADROTOR_TOGETHER_REGULATOR_H */
