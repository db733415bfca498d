/* pendulum_ekf: Extended Kalman filter of the plant "pendulum", in single precision.
 *
 * Written by plantc 0.1.0 from model 65098682. Do not edit: change the model, export again.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 *
 *    theta' = omega
 *    omega' = (torque + draught - mass gravity length sin(theta)) / (mass length^2)
 *    encoder = theta + noise
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
#ifndef PENDULUM_EKF_H
#define PENDULUM_EKF_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum
{
    PENDULUM_EKF_OK = 0,              /* ok */
    PENDULUM_EKF_GATED = 1,           /* innovation beyond the gate: reading not used */
    PENDULUM_EKF_CLAMPED = 2,         /* a value (a variance, a command) was held at its limit */
    PENDULUM_EKF_SKIPPED = 3,         /* a sensor was refused and skipped: see its own status */
    PENDULUM_EKF_RECOVERED = 4,       /* gated too often in a row: P inflated, reading taken without gate */
    PENDULUM_EKF_BAD_INPUT = -1,      /* an input is outside its range, or not a number */
    PENDULUM_EKF_BAD_PARAM = -2,      /* a parameter is outside its range, or not a number */
    PENDULUM_EKF_NOT_POSITIVE = -3,   /* a variance would not be positive */
    PENDULUM_EKF_OVERFLOW = -4        /* the result would leave its range */
} pendulum_ekf_status_t;

/* What may be tuned without exporting again. Start from PENDULUM_EKF_PARAMS_DEFAULT. */
typedef struct
{
    float mass;              /* mass                                                [kg]          0.001 .. 1000 */
    float length;            /* length                                              [m]           0.001 .. 100 */
    float gravity;           /* gravity                                             [m/s^2]       0 .. 100 */
    float density_draught;   /* torque of moving air                                [(N m)^2/Hz]  0 .. 1e6 */
    float variance_encoder;  /* noise of encoder                                    [rad^2]       1e-12 .. 1e6 */
    float gate_encoder;      /* largest accepted NIS of encoder; 0: no gate                       0 .. 1e6 */
    uint32_t reject_limit;   /* readings gated in a row after which step recovers; 0: never */
    float inflation;         /* factor on P at a recovery                                         1 .. 1e6 */
    float theta_0;           /* initial theta                                       [rad]         -pi .. pi */
    float omega_0;           /* initial omega                                       [rad/s]       -100 .. 100 */
    float variance_theta_0;  /* variance of the error of theta_0                    [rad^2]       1e-12 .. 1e6 */
    float variance_omega_0;  /* variance of the error of omega_0                    [rad^2/s^2]   1e-12 .. 1e6 */
} pendulum_ekf_params_t;

/* The memory. Copy it, save it, put it where you like. */
typedef struct
{
    float theta;                /* angle from the lower rest (wrapped)                 [rad]    -pi .. pi */
    float omega;                /* its rate                                            [rad/s]  -100 .. 100 */
    /* covariance of the error, upper triangle by rows */
    float covariance[3];        /* 1e-20 .. 1e9; -1e9 .. 1e9 */
    uint32_t rejected_encoder;  /* readings of encoder gated in a row; stays at its largest value */
} pendulum_ekf_state_t;

typedef struct
{
    float torque;  /* torque at the pivot          [N m]  -10 .. 10 */
    float dt;      /* time since the last predict  [s]    1e-5 .. 0.1 */
} pendulum_ekf_predict_in_t;

typedef struct
{
    float encoder;  /* measured angle  [rad]  -1000 .. 1000 */
} pendulum_ekf_update_encoder_in_t;

typedef struct
{
    float innovation;  /* measured minus expected, wrapped                    [rad] */
    float variance;    /* of the innovation                                   [rad^2] */
    float nis;         /* normalised innovation squared, of the whole reading */
} pendulum_ekf_update_encoder_out_t;

typedef struct
{
    float torque;      /* torque at the pivot                    [N m]  -10 .. 10 */
    float dt;          /* time since the last predict            [s]    1e-5 .. 0.1 */
    bool has_encoder;  /* whether there is a reading of encoder */
    float encoder;     /* measured angle                         [rad]  -1000 .. 1000 */
} pendulum_ekf_step_in_t;

typedef struct
{
    pendulum_ekf_status_t status_encoder;       /* status of encoder itself */
    pendulum_ekf_update_encoder_out_t encoder;  /* what update_encoder reported, else zeros */
} pendulum_ekf_step_out_t;

typedef struct
{
    float factor;  /* factor on the covariance  1 .. 1e6 */
} pendulum_ekf_inflate_in_t;

#define PENDULUM_EKF_PARAMS_DEFAULT {0.2f, 0.5f, 9.81f, 0.001f, 0.0001f, 0.0f, 0U, 100.0f, 0.0f, 0.0f, 1.0f, 1.0f}

/* Start (or start again) from the initial estimate in the parameters; every parameter is checked here. */
pendulum_ekf_status_t pendulum_ekf_init(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params);

/* Move the estimate one step ahead. */
pendulum_ekf_status_t pendulum_ekf_predict(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                           const pendulum_ekf_predict_in_t *in);

/* Correct the estimate with one reading of encoder. `out` is written when the status is not negative. */
pendulum_ekf_status_t pendulum_ekf_update_encoder(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                                  const pendulum_ekf_update_encoder_in_t *in,
                                                  pendulum_ekf_update_encoder_out_t *out);

/* Predict, then every sensor that has a reading, in this order; a refused sensor is skipped. `out` is written when
 * the status is not negative. */
pendulum_ekf_status_t pendulum_ekf_step(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                        const pendulum_ekf_step_in_t *in, pendulum_ekf_step_out_t *out);

/* Multiply the covariance by a factor and leave the estimate: after a disturbance the model does not know. */
pendulum_ekf_status_t pendulum_ekf_inflate(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                           const pendulum_ekf_inflate_in_t *in);

/* The model this code was written from, for a start-up check against the configuration you flew last. */
const char *pendulum_ekf_model(void);

/* A sentence for a status, for logs. */
const char *pendulum_ekf_status_text(pendulum_ekf_status_t status);

#ifdef __cplusplus
}
#endif

#endif /* PENDULUM_EKF_H */
