/* quadrotor_steady_regulator: output regulator of the plant "quadrotor": follows x, y, z, yaw, in single precision.
 *
 * Written by plantc 0.1.0 from model 16afd8e2. Do not edit: change the model, export again.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 *
 *    generator_x: w_reading[0]+ = w_reading[0] + 0.02 w_reading[1]
 *    generator_x: w_reading[1]+ = w_reading[1] + 0.02 w_reading[2]
 *    generator_x: w_reading[2]+ = w_reading[2] + 0.02 w_reading[3]
 *    generator_x: w_reading[3]+ = w_reading[3] + 0.02 w_reading[4]
 *    generator_x: w_reading[4]+ = w_reading[4] + 0.02 w_reading[5]
 *    generator_x: w_reading[5]+ = w_reading[5] + 0.02 w_reading[6]
 *    generator_x: w_reading[6]+ = w_reading[6]
 *    generator_x: reading = w_reading[0] + noise
 *    generator_y: w_reading[0]+ = w_reading[0] + 0.02 w_reading[1]
 *    generator_y: w_reading[1]+ = w_reading[1] + 0.02 w_reading[2]
 *    generator_y: w_reading[2]+ = w_reading[2] + 0.02 w_reading[3]
 *    generator_y: w_reading[3]+ = w_reading[3] + 0.02 w_reading[4]
 *    generator_y: w_reading[4]+ = w_reading[4] + 0.02 w_reading[5]
 *    generator_y: w_reading[5]+ = w_reading[5] + 0.02 w_reading[6]
 *    generator_y: w_reading[6]+ = w_reading[6]
 *    generator_y: reading = w_reading[0] + noise
 *    generator_z: w_reading[0]+ = w_reading[0] + 0.02 w_reading[1]
 *    generator_z: w_reading[1]+ = w_reading[1] + 0.02 w_reading[2]
 *    generator_z: w_reading[2]+ = w_reading[2] + 0.02 w_reading[3]
 *    generator_z: w_reading[3]+ = w_reading[3] + 0.02 w_reading[4]
 *    generator_z: w_reading[4]+ = w_reading[4] + 0.02 w_reading[5]
 *    generator_z: w_reading[5]+ = w_reading[5] + 0.02 w_reading[6]
 *    generator_z: w_reading[6]+ = w_reading[6]
 *    generator_z: reading = w_reading[0] + noise
 *    generator_yaw: w_reading[0]+ = w_reading[0] + 0.02 w_reading[1]
 *    generator_yaw: w_reading[1]+ = w_reading[1] + 0.02 w_reading[2]
 *    generator_yaw: w_reading[2]+ = w_reading[2] + 0.02 w_reading[3]
 *    generator_yaw: w_reading[3]+ = w_reading[3] + 0.02 w_reading[4]
 *    generator_yaw: w_reading[4]+ = w_reading[4] + 0.02 w_reading[5]
 *    generator_yaw: w_reading[5]+ = w_reading[5] + 0.02 w_reading[6]
 *    generator_yaw: w_reading[6]+ = w_reading[6]
 *    generator_yaw: reading = w_reading[0] + noise
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
 * feedback.w_x = generator_x.w_reading
 * feedback.w_y = generator_y.w_reading
 * feedback.w_z = generator_z.w_reading
 * feedback.w_yaw = generator_yaw.w_reading
 * No heap, no globals, no recursion. One state for each instance, used by one context at a time. A call that returns a
 * negative status leaves the state and the outputs exactly as they were. Positive: degraded, the highest is returned.
 * Assumes the FPU rounds to nearest and keeps denormals and NaN (no flush to zero, no default NaN, no -ffast-math).
 */
#ifndef QUADROTOR_STEADY_REGULATOR_H
#define QUADROTOR_STEADY_REGULATOR_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum
{
    QUADROTOR_STEADY_REGULATOR_OK = 0,              /* ok */
    QUADROTOR_STEADY_REGULATOR_GATED = 1,           /* innovation beyond the gate: reading not used */
    QUADROTOR_STEADY_REGULATOR_CLAMPED = 2,         /* a value (a variance, a command) was held at its limit */
    QUADROTOR_STEADY_REGULATOR_SKIPPED = 3,         /* a sensor was refused and skipped: see its own status */
    QUADROTOR_STEADY_REGULATOR_RECOVERED = 4,       /* gated too often in a row: P inflated, reading taken without gate */
    QUADROTOR_STEADY_REGULATOR_BAD_INPUT = -1,      /* an input is outside its range, or not a number */
    QUADROTOR_STEADY_REGULATOR_BAD_PARAM = -2,      /* a parameter is outside its range, or not a number */
    QUADROTOR_STEADY_REGULATOR_NOT_POSITIVE = -3,   /* a variance would not be positive */
    QUADROTOR_STEADY_REGULATOR_OVERFLOW = -4        /* the result would leave its range */
} quadrotor_steady_regulator_status_t;

/* What may be tuned without exporting again. */
typedef struct
{
    float w_reading_0[7];  /* initial w_reading  -1e6 .. 1e6 */
} quadrotor_steady_regulator_generator_x_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    float w_reading[7];  /* generates reading  -1e6 .. 1e6 */
} quadrotor_steady_regulator_generator_x_state_t;

typedef struct
{
    float innovation;  /* measured minus expected, all sensors */
} quadrotor_steady_regulator_generator_x_update_out_t;

typedef struct
{
    quadrotor_steady_regulator_status_t status_update;           /* status of the update itself */
    quadrotor_steady_regulator_generator_x_update_out_t update;  /* what update reported, else zeros */
} quadrotor_steady_regulator_generator_x_step_out_t;

/* generator_y is the same block as generator_x, with a memory and parameters of its own. */
typedef quadrotor_steady_regulator_generator_x_params_t quadrotor_steady_regulator_generator_y_params_t;
typedef quadrotor_steady_regulator_generator_x_state_t quadrotor_steady_regulator_generator_y_state_t;
typedef quadrotor_steady_regulator_generator_x_step_out_t quadrotor_steady_regulator_generator_y_step_out_t;

/* generator_z is the same block as generator_x, with a memory and parameters of its own. */
typedef quadrotor_steady_regulator_generator_x_params_t quadrotor_steady_regulator_generator_z_params_t;
typedef quadrotor_steady_regulator_generator_x_state_t quadrotor_steady_regulator_generator_z_state_t;
typedef quadrotor_steady_regulator_generator_x_step_out_t quadrotor_steady_regulator_generator_z_step_out_t;

/* generator_yaw is the same block as generator_x, with a memory and parameters of its own. */
typedef quadrotor_steady_regulator_generator_x_params_t quadrotor_steady_regulator_generator_yaw_params_t;
typedef quadrotor_steady_regulator_generator_x_state_t quadrotor_steady_regulator_generator_yaw_state_t;
typedef quadrotor_steady_regulator_generator_x_step_out_t quadrotor_steady_regulator_generator_yaw_step_out_t;

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
} quadrotor_steady_regulator_feedback_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    uint8_t unused;  /* nothing to remember */
} quadrotor_steady_regulator_feedback_state_t;

typedef struct
{
    float rotor_1;  /* speed of rotor 1; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
    float rotor_2;  /* speed of rotor 2; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
    float rotor_3;  /* speed of rotor 3; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
    float rotor_4;  /* speed of rotor 4; keeps its last value when a call is refused  [rad/s]  -10000 .. 10000 */
} quadrotor_steady_regulator_feedback_step_out_t;

/* What may be tuned without exporting again. Start from QUADROTOR_STEADY_REGULATOR_PARAMS_DEFAULT. */
typedef struct
{
    quadrotor_steady_regulator_generator_x_params_t generator_x;
    quadrotor_steady_regulator_generator_y_params_t generator_y;
    quadrotor_steady_regulator_generator_z_params_t generator_z;
    quadrotor_steady_regulator_generator_yaw_params_t generator_yaw;
    quadrotor_steady_regulator_feedback_params_t feedback;
} quadrotor_steady_regulator_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    quadrotor_steady_regulator_generator_x_state_t generator_x;
    quadrotor_steady_regulator_generator_y_state_t generator_y;
    quadrotor_steady_regulator_generator_z_state_t generator_z;
    quadrotor_steady_regulator_generator_yaw_state_t generator_yaw;
    quadrotor_steady_regulator_feedback_state_t feedback;
} quadrotor_steady_regulator_state_t;

typedef struct
{
    bool generator_x_has_readings;    /* whether there are readings */
    float generator_x_reading;        /* reading of reading                   -10 .. 10 */
    bool generator_y_has_readings;    /* whether there are readings */
    float generator_y_reading;        /* reading of reading                   -10 .. 10 */
    bool generator_z_has_readings;    /* whether there are readings */
    float generator_z_reading;        /* reading of reading                   -10 .. 10 */
    bool generator_yaw_has_readings;  /* whether there are readings */
    float generator_yaw_reading;      /* reading of reading                   -10 .. 10 */
    float feedback_x;                 /* position                    [m]      -10000 .. 10000 */
    float feedback_vx;                /* velocity along x            [m/s]    -10000 .. 10000 */
    float feedback_y;                 /* position                    [m]      -10000 .. 10000 */
    float feedback_vy;                /* velocity along y            [m/s]    -10000 .. 10000 */
    float feedback_z;                 /* altitude, upwards           [m]      -10000 .. 10000 */
    float feedback_vz;                /* velocity along z            [m/s]    -10000 .. 10000 */
    float feedback_roll;              /* roll angle, not wrapped     [rad]    -30 .. 30 */
    float feedback_roll_rate;         /* its rate                    [rad/s]  -1000 .. 1000 */
    float feedback_pitch;             /* pitch angle, not wrapped    [rad]    -30 .. 30 */
    float feedback_pitch_rate;        /* its rate                    [rad/s]  -1000 .. 1000 */
    float feedback_yaw;               /* yaw angle, not wrapped      [rad]    -30 .. 30 */
    float feedback_yaw_rate;          /* its rate                    [rad/s]  -1000 .. 1000 */
} quadrotor_steady_regulator_step_in_t;

typedef struct
{
    quadrotor_steady_regulator_generator_x_step_out_t generator_x;      /* what generator_x gave */
    quadrotor_steady_regulator_generator_y_step_out_t generator_y;      /* what generator_y gave */
    quadrotor_steady_regulator_generator_z_step_out_t generator_z;      /* what generator_z gave */
    quadrotor_steady_regulator_generator_yaw_step_out_t generator_yaw;  /* what generator_yaw gave */
    quadrotor_steady_regulator_feedback_step_out_t feedback;            /* what feedback gave */
} quadrotor_steady_regulator_step_out_t;

#define QUADROTOR_STEADY_REGULATOR_PARAMS_DEFAULT {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, \
    0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, \
    0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.7183f, 212.7183f, 212.7183f, \
    212.7183f}}

/* Start (or start again) from the parameters; every parameter is checked here. */
quadrotor_steady_regulator_status_t quadrotor_steady_regulator_init(quadrotor_steady_regulator_state_t *state,
                                                                    const quadrotor_steady_regulator_params_t *params);

/* Call generator_x, then generator_y, then generator_z, then generator_yaw, then feedback. `out` is written when the
 * status is not negative. */
quadrotor_steady_regulator_status_t quadrotor_steady_regulator_step(quadrotor_steady_regulator_state_t *state,
                                                                    const quadrotor_steady_regulator_params_t *params,
                                                                    const quadrotor_steady_regulator_step_in_t *in,
                                                                    quadrotor_steady_regulator_step_out_t *out);

/* The model this code was written from, for a start-up check against the configuration you flew last. */
const char *quadrotor_steady_regulator_model(void);

/* A sentence for a status, for logs. */
const char *quadrotor_steady_regulator_status_text(quadrotor_steady_regulator_status_t status);

#ifdef __cplusplus
}
#endif

#endif /* QUADROTOR_STEADY_REGULATOR_H */
