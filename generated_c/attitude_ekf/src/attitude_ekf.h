/* attitude_ekf: Extended Kalman filter of the plant "attitude", in single precision.
 *
 * Written by plantc 0.1.0 from model dc394edc. Do not edit: change the model, export again.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 *
 *    rate of q[0] = gyro[0] - bias[0] + gyro_noise[0]
 *    rate of q[1] = gyro[1] - bias[1] + gyro_noise[1]
 *    rate of q[2] = gyro[2] - bias[2] + gyro_noise[2]
 *    bias[0]' = bias_walk[0]
 *    bias[1]' = bias_walk[1]
 *    bias[2]' = bias_walk[2]
 *    accelerometer[0] = -19.6133 (q[1] q[3] - q[0] q[2]) + noise
 *    accelerometer[1] = -19.6133 (q[2] q[3] + q[0] q[1]) + noise
 *    accelerometer[2] = -9.80665 (1 - 2 (q[1]^2 + q[2]^2)) + noise
 *    magnetometer[0] = (1 - 2 (q[2]^2 + q[3]^2)) field_north + 2 (q[1] q[3] - q[0] q[2]) field_down + noise
 *    magnetometer[1] = 2 (q[1] q[2] - q[0] q[3]) field_north + 2 (q[2] q[3] + q[0] q[1]) field_down + noise
 *    magnetometer[2] = 2 (q[1] q[3] + q[0] q[2]) field_north + (1 - 2 (q[1]^2 + q[2]^2)) field_down + noise
 *
 * Discretised by euler.
 * Noise densities are integrated over the step.
 * Covariance packed (upper triangle by rows); one scalar update for each sensor row.
 * Mathematics: plantc's own, in the source; largest errors: cos (1.5 ulp), sin (1.5 ulp). The same bits on every
 * machine if built with -ffp-contract=off.
 * No heap, no globals, no recursion. One state for each instance, used by one context at a time. A call that returns a
 * negative status leaves the state and the outputs exactly as they were. Positive: degraded, the highest is returned.
 * Assumes the FPU rounds to nearest and keeps denormals and NaN (no flush to zero, no default NaN, no -ffast-math).
 */
#ifndef ATTITUDE_EKF_H
#define ATTITUDE_EKF_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum
{
    ATTITUDE_EKF_OK = 0,              /* ok */
    ATTITUDE_EKF_GATED = 1,           /* innovation beyond the gate: reading not used */
    ATTITUDE_EKF_CLAMPED = 2,         /* a value (a variance, a command) was held at its limit */
    ATTITUDE_EKF_SKIPPED = 3,         /* a sensor was refused and skipped: see its own status */
    ATTITUDE_EKF_RECOVERED = 4,       /* gated too often in a row: P inflated, reading taken without gate */
    ATTITUDE_EKF_BAD_INPUT = -1,      /* an input is outside its range, or not a number */
    ATTITUDE_EKF_BAD_PARAM = -2,      /* a parameter is outside its range, or not a number */
    ATTITUDE_EKF_NOT_POSITIVE = -3,   /* a variance would not be positive */
    ATTITUDE_EKF_OVERFLOW = -4        /* the result would leave its range */
} attitude_ekf_status_t;

/* What may be tuned without exporting again. Start from ATTITUDE_EKF_PARAMS_DEFAULT. */
typedef struct
{
    float field_north;               /* magnetic field, unit length: horizontal part                        0 .. 1 */
    float field_down;                /* magnetic field, unit length: part pointing down                     -1 .. 1 */
    float density_gyro_noise[3];     /* noise of the gyroscope                              [rad^2/s^2/Hz]  0 .. 1e6 */
    float density_bias_walk[3];      /* drift of the bias                                   [rad^2/s^4/Hz]  0 .. 1e6 */
    float gate_accelerometer;        /* largest accepted NIS of accelerometer; 0: no gate                   0 .. 1e6 */
    /* noise of magnetometer */
    float variance_magnetometer[3];  /* 1e-12 .. 1e6 */
    float gate_magnetometer;         /* largest accepted NIS of magnetometer; 0: no gate                    0 .. 1e6 */
    uint32_t reject_limit;           /* readings gated in a row after which step recovers; 0: never */
    float inflation;                 /* factor on P at a recovery                                           1 .. 1e6 */
    /* initial q */
    float q_0[4];                    /* -1.01 .. 1.01 */
    float bias_0[3];                 /* initial bias                                        [rad/s]         -1 .. 1 */
    /* variance of the error of q_0 */
    float variance_q_0[3];           /* [rad^2]  1e-12 .. 1e6 */
    /* variance of the error of bias_0 */
    float variance_bias_0[3];        /* [rad^2/s^2]  1e-12 .. 1e6 */
} attitude_ekf_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    float q[4];                       /* attitude, body to world (w, x, y, z)                         -1.01 .. 1.01 */
    float bias[3];                    /* bias of the gyroscope                               [rad/s]  -1 .. 1 */
    /* covariance of the error, upper triangle by rows */
    float covariance[21];             /* 1e-20 .. 10; -10 .. 10; -3.16228 .. 3.16228; ... */
    uint32_t rejected_accelerometer;  /* readings of accelerometer gated in a row; stays at its largest value */
    uint32_t rejected_magnetometer;   /* readings of magnetometer gated in a row; stays at its largest value */
} attitude_ekf_state_t;

typedef struct
{
    float gyro[3];  /* angular velocity as the gyroscope measures it  [rad/s]  -40 .. 40 */
    float dt;       /* time since the last predict                    [s]      0.0001 .. 0.1 */
} attitude_ekf_predict_in_t;

typedef struct
{
    float accelerometer[3];  /* specific force  [m/s^2]  -200 .. 200 */
} attitude_ekf_update_accelerometer_in_t;

typedef struct
{
    float innovation[3];  /* measured minus expected                             [m/s^2] */
    float variance[3];    /* of the innovation                                   [m^2/s^4] */
    float nis;            /* normalised innovation squared, of the whole reading */
} attitude_ekf_update_accelerometer_out_t;

typedef struct
{
    float magnetometer[3];  /* field, scaled to unit length  -2 .. 2 */
} attitude_ekf_update_magnetometer_in_t;

typedef struct
{
    float innovation[3];  /* measured minus expected */
    float variance[3];    /* of the innovation */
    float nis;            /* normalised innovation squared, of the whole reading */
} attitude_ekf_update_magnetometer_out_t;

typedef struct
{
    float gyro[3];           /* angular velocity as the gyroscope measures it  [rad/s]  -40 .. 40 */
    float dt;                /* time since the last predict                    [s]      0.0001 .. 0.1 */
    bool has_accelerometer;  /* whether there is a reading of accelerometer */
    float accelerometer[3];  /* specific force                                 [m/s^2]  -200 .. 200 */
    bool has_magnetometer;   /* whether there is a reading of magnetometer */
    float magnetometer[3];   /* field, scaled to unit length                            -2 .. 2 */
} attitude_ekf_step_in_t;

typedef struct
{
    attitude_ekf_status_t status_accelerometer;             /* status of accelerometer itself */
    attitude_ekf_update_accelerometer_out_t accelerometer;  /* what update_accelerometer reported, else zeros */
    attitude_ekf_status_t status_magnetometer;              /* status of magnetometer itself */
    attitude_ekf_update_magnetometer_out_t magnetometer;    /* what update_magnetometer reported, else zeros */
} attitude_ekf_step_out_t;

typedef struct
{
    float factor;  /* factor on the covariance  1 .. 1e6 */
} attitude_ekf_inflate_in_t;

#define ATTITUDE_EKF_PARAMS_DEFAULT {0.5f, 0.8f, {9.025e-7f, 9.025e-7f, 9.025e-7f}, {1.0e-10f, 1.0e-10f, 1.0e-10f}, \
    0.0f, {0.0025f, 0.0025f, 0.0025f}, 0.0f, 0U, 100.0f, {1.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.04f, 0.04f, \
    0.04f}, {0.0001f, 0.0001f, 0.0001f}}

/* Start (or start again) from the initial estimate in the parameters; every parameter is checked here. */
attitude_ekf_status_t attitude_ekf_init(attitude_ekf_state_t *state, const attitude_ekf_params_t *params);

/* Move the estimate one step ahead. */
attitude_ekf_status_t attitude_ekf_predict(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                           const attitude_ekf_predict_in_t *in);

/* Correct the estimate with one reading of accelerometer. `out` is written when the status is not negative. */
attitude_ekf_status_t attitude_ekf_update_accelerometer(attitude_ekf_state_t *state,
                                                        const attitude_ekf_params_t *params,
                                                        const attitude_ekf_update_accelerometer_in_t *in,
                                                        attitude_ekf_update_accelerometer_out_t *out);

/* Correct the estimate with one reading of magnetometer. `out` is written when the status is not negative. */
attitude_ekf_status_t attitude_ekf_update_magnetometer(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                                       const attitude_ekf_update_magnetometer_in_t *in,
                                                       attitude_ekf_update_magnetometer_out_t *out);

/* Predict, then every sensor that has a reading, in this order; a refused sensor is skipped. `out` is written when
 * the status is not negative. */
attitude_ekf_status_t attitude_ekf_step(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                        const attitude_ekf_step_in_t *in, attitude_ekf_step_out_t *out);

/* Multiply the covariance by a factor and leave the estimate: after a disturbance the model does not know. */
attitude_ekf_status_t attitude_ekf_inflate(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                           const attitude_ekf_inflate_in_t *in);

/* The model this code was written from, for a start-up check against the configuration you flew last. */
const char *attitude_ekf_model(void);

/* A sentence for a status, for logs. */
const char *attitude_ekf_status_text(attitude_ekf_status_t status);

#ifdef __cplusplus
}
#endif

#endif /* ATTITUDE_EKF_H */
