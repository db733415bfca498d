/* pendulum_ekf: see pendulum_ekf.h. Written by plantc 0.1.0 from model ac32d234. */
#include "pendulum_ekf.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "pendulum_ekf checks for NaN and infinity: do not build it with -ffast-math"
#endif

static pendulum_ekf_status_t pendulum_ekf_higher(pendulum_ekf_status_t first, pendulum_ekf_status_t second)
{
    return (first > second) ? first : second;
}

/* Keeps the variances between floor and ceiling; called only when one is outside. Scaling row and column together keeps
 * the matrix positive definite. What lies beside the diagonal is then compared with its bounds. */
static pendulum_ekf_status_t pendulum_ekf_hold_variances(float covariance[3])
{
    pendulum_ekf_status_t status = PENDULUM_EKF_OK;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 2U; i++)
    {
        if (!(covariance[at] >= 0.0f))
        {
            status = PENDULUM_EKF_NOT_POSITIVE;
        }
        at = at + (2U - i);
    }
    at = 0U;
    for (uint32_t i = 0U; (i < 2U) && (status >= PENDULUM_EKF_OK); i++)
    {
        const float floor_i = 1.0e-20f;
        const float ceiling_i = 1.0e9f;

        if (covariance[at] > ceiling_i)
        {
            const float factor = sqrtf(ceiling_i / covariance[at]);
            uint32_t other = i;

            for (uint32_t j = 0U; j < i; j++)
            {
                covariance[other] = covariance[other] * factor;
                other = other + ((2U - 1U) - j);
            }
            for (uint32_t j = i + 1U; j < 2U; j++)
            {
                covariance[at + (j - i)] = covariance[at + (j - i)] * factor;
            }
            covariance[at] = ceiling_i;
            status = PENDULUM_EKF_CLAMPED;
        }
        else if (covariance[at] < floor_i)
        {
            covariance[at] = floor_i;
            status = PENDULUM_EKF_CLAMPED;
        }
        else
        {
            /* within its bounds */
        }
        at = at + (2U - i);
    }
    for (uint32_t i = 0U; i < 3U; i++)
    {
        if ((status >= PENDULUM_EKF_OK) && !(fabsf(covariance[i]) <= 1.0e9f))
        {
            status = PENDULUM_EKF_OVERFLOW;
        }
    }
    return status;
}

/* Whether a covariance is within its bounds beyond doubt: a sum of magnitudes below a bound bounds each of them,
 * and is not below it where one is NaN. */
static bool pendulum_ekf_is_bounded(const float covariance[3])
{
    float sum_0 = 0.0f;
    float sum_1 = 0.0f;
    float sum_2 = 0.0f;

    for (uint32_t i = 0U; i < 3U; i = i + 3U)
    {
        sum_0 = sum_0 + fabsf(covariance[i]);
        sum_1 = sum_1 + fabsf(covariance[i + 1U]);
        sum_2 = sum_2 + fabsf(covariance[i + 2U]);
    }
    return (((sum_0 + sum_1) + (sum_2)) <= 1.0e9f)
           && (covariance[0] >= 1.0e-20f)
           && (covariance[2] >= 1.0e-20f);
}

static pendulum_ekf_status_t pendulum_ekf_init_core(pendulum_ekf_state_t *after, const pendulum_ekf_params_t *params)
{
    pendulum_ekf_status_t status = PENDULUM_EKF_OK;

    if (!((params->mass >= 0.001f) && (params->mass <= 1000.0f) && (params->length >= 0.001f)
          && (params->length <= 100.0f) && (params->gravity >= 0.0f) && (params->gravity <= 100.0f)
          && (params->density_draught >= 0.0f) && (params->density_draught <= 1000000.0f)
          && (params->variance_encoder >= 1.0e-12f) && (params->variance_encoder <= 1000000.0f)
          && (params->gate_encoder >= 0.0f) && (params->gate_encoder <= 1000000.0f) && (params->inflation >= 1.0f)
          && (params->inflation <= 1000000.0f) && (fabsf(params->theta_0) <= 3.1415927f)
          && (fabsf(params->omega_0) <= 100.0f) && (params->variance_theta_0 >= 1.0e-12f)
          && (params->variance_theta_0 <= 1000000.0f) && (params->variance_omega_0 >= 1.0e-12f)
          && (params->variance_omega_0 <= 1000000.0f)))
    {
        status = PENDULUM_EKF_BAD_PARAM;
    }
    else
    {
        after->theta = params->theta_0;
        after->omega = params->omega_0;
        after->covariance[0] = 0.0f;
        after->covariance[1] = 0.0f;
        after->covariance[2] = 0.0f;
        after->covariance[0] = params->variance_theta_0;
        after->covariance[2] = params->variance_omega_0;
        after->rejected_encoder = 0U;

        /* judge, then commit */
        if (!pendulum_ekf_is_bounded(after->covariance))
        {
            status = pendulum_ekf_hold_variances(after->covariance);
        }
    }
    return status;
}

/* 15 additions, 29 multiplications, 1 division, 1 negation, cosf, floorf, sinf. */
static pendulum_ekf_status_t pendulum_ekf_predict_core(const pendulum_ekf_state_t *before, pendulum_ekf_state_t *after,
                                                       const pendulum_ekf_params_t *params, const float torque,
                                                       const float dt)
{
    pendulum_ekf_status_t status = PENDULUM_EKF_OK;

    after->rejected_encoder = before->rejected_encoder;

    if (!((fabsf(torque) <= 10.0f) && (dt >= 0.00001f) && (dt <= 0.1f)))
    {
        status = PENDULUM_EKF_BAD_INPUT;
    }
    else
    {
        /* x, F = dx/dx and Q over one step, by euler */
        /* theta' = omega */
        /* omega' = (torque + draught - mass gravity length sin(theta)) / (mass length^2) */
        const float theta = before->theta;
        const float omega = before->omega;
        const float v = theta + (omega * dt);
        after->theta = v - (6.2831855f * floorf((v * 0.15915494f) + 0.5f));
        const float length = params->length;
        const float mass = params->mass;
        const float v_2 = length * (mass * params->gravity);
        const float v_3 = 1.0f / (mass * (length * length));
        after->omega = omega + (dt * ((torque - (v_2 * sinf(theta))) * v_3));
        const float f_1_0 = -(dt * (v_3 * (v_2 * cosf(theta))));
        const float v_4 = v_3 * (params->density_draught * v_3);
        const float v_5 = dt * dt;
        const float q_0_0 = v_4 * ((dt * v_5) * 0.33333334f);
        const float q_0_1 = v_4 * (0.5f * v_5);
        const float q_1_1 = dt * v_4;

        /* P = F P F' + Q */
        {
            const float p_0_0 = before->covariance[0];
            const float p_0_1 = before->covariance[1];
            const float v_6 = p_0_0 + (dt * p_0_1);
            const float p_1_1 = before->covariance[2];
            const float v_7 = p_0_1 + (dt * p_1_1);
            after->covariance[0] = q_0_0 + (v_6 + (dt * v_7));
            after->covariance[1] = q_0_1 + (v_7 + (f_1_0 * v_6));
            after->covariance[2] = q_1_1 + ((p_1_1 + (f_1_0 * p_0_1)) + (f_1_0 * (p_0_1 + (f_1_0 * p_0_0))));
        }

        /* judge, then commit */
        if (!pendulum_ekf_is_bounded(after->covariance))
        {
            status = pendulum_ekf_hold_variances(after->covariance);
        }
        if (status >= PENDULUM_EKF_OK)
        {
            if (!((fabsf(after->theta) <= 3.15f) && (fabsf(after->omega) <= 100.0f)))
            {
                status = PENDULUM_EKF_OVERFLOW;
            }
        }
    }
    return status;
}

/* 10 additions, 13 multiplications, 1 division, 3 negations, 1 selection, floorf 2 times. */
static pendulum_ekf_status_t pendulum_ekf_update_encoder_core(const pendulum_ekf_state_t *before,
                                                              pendulum_ekf_state_t *after,
                                                              const pendulum_ekf_params_t *params, const float encoder,
                                                              const float gate, pendulum_ekf_update_encoder_out_t *out)
{
    float delta[2];
    float nis[1];
    float row_variance[1];
    pendulum_ekf_status_t status = PENDULUM_EKF_OK;

    if (!(fabsf(encoder) <= 1000.0f))
    {
        status = PENDULUM_EKF_BAD_INPUT;
    }
    else
    {
        /* residual = encoder - theta, wrapped */
        const float v = encoder - before->theta;
        const float residual = v - (6.2831855f * floorf((v * 0.15915494f) + 0.5f));

        /* variance of the innovation: diagonal of H P H' + R */
        {
            out->variance = params->variance_encoder + before->covariance[0];
        }
        out->innovation = residual;

        /* d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const float p_0_0 = before->covariance[0];
            const float r_0 = params->variance_encoder;
            const float s = r_0 + p_0_0;
            const float per_s = 1.0f / ((s >= 1.0e-20f) ? s : 1.0f);
            const float minus_per_s = -per_s;
            const float n_0 = p_0_0 * minus_per_s;
            const float minus_r = -r_0;
            after->covariance[0] = n_0 * minus_r;
            const float p_0_1 = before->covariance[1];
            const float n_1 = p_0_1 * minus_per_s;
            after->covariance[1] = n_1 * minus_r;
            after->covariance[2] = before->covariance[2] + (p_0_1 * n_1);
            const float minus_e = -residual;
            delta[0] = n_0 * minus_e;
            delta[1] = n_1 * minus_e;
            nis[0] = residual * (residual * per_s);
            row_variance[0] = s;
        }

        if (!(row_variance[0] >= 1.0e-20f))
        {
            status = PENDULUM_EKF_NOT_POSITIVE;
        }
        else
        {
            if (!(nis[0] <= 1.0e30f))
            {
                status = PENDULUM_EKF_OVERFLOW;
            }
            else
            {
                out->nis = nis[0];

                /* accepted? */
                if ((gate <= 0.0f) || (nis[0] <= gate))
                {
                    /* x = x + d */
                    const float v_2 = before->theta + delta[0];
                    after->theta = v_2 - (6.2831855f * floorf(0.5f + (0.15915494f * v_2)));
                    after->omega = before->omega + delta[1];
                    after->rejected_encoder = 0U;

                    /* judge, then commit */
                    if (!pendulum_ekf_is_bounded(after->covariance))
                    {
                        status = pendulum_ekf_hold_variances(after->covariance);
                    }
                    if (status >= PENDULUM_EKF_OK)
                    {
                        if (!((fabsf(after->theta) <= 3.15f) && (fabsf(after->omega) <= 100.0f)))
                        {
                            status = PENDULUM_EKF_OVERFLOW;
                        }
                    }
                }
                else
                {
                    *after = *before;
                    if (after->rejected_encoder < UINT32_MAX)
                    {
                        after->rejected_encoder = after->rejected_encoder + 1U;
                    }
                    status = pendulum_ekf_higher(status, PENDULUM_EKF_GATED);
                }
            }
        }
    }
    return status;
}

/* 3 multiplications. */
static pendulum_ekf_status_t pendulum_ekf_inflate_core(const pendulum_ekf_state_t *before, pendulum_ekf_state_t *after,
                                                       const float factor)
{
    pendulum_ekf_status_t status = PENDULUM_EKF_OK;

    after->theta = before->theta;
    after->omega = before->omega;
    after->rejected_encoder = before->rejected_encoder;

    if (!((factor >= 1.0f) && (factor <= 1000000.0f)))
    {
        status = PENDULUM_EKF_BAD_INPUT;
    }
    else
    {
        /* P = factor P */
        {
            after->covariance[0] = factor * before->covariance[0];
            after->covariance[1] = factor * before->covariance[1];
            after->covariance[2] = factor * before->covariance[2];
        }

        /* judge, then commit */
        if (!pendulum_ekf_is_bounded(after->covariance))
        {
            status = pendulum_ekf_hold_variances(after->covariance);
        }
    }
    return status;
}

static pendulum_ekf_status_t pendulum_ekf_step_core(const pendulum_ekf_state_t *before, pendulum_ekf_state_t *after,
                                                    const pendulum_ekf_params_t *params, const float torque,
                                                    const float dt, const bool has_encoder, const float encoder,
                                                    pendulum_ekf_step_out_t *out)
{
    pendulum_ekf_state_t work[3];
    pendulum_ekf_state_t *latest = &work[0];
    pendulum_ekf_state_t *spare = &work[1];
    pendulum_ekf_status_t status = pendulum_ekf_predict_core(before, latest, params, torque, dt);

    if (status >= PENDULUM_EKF_OK)
    {
        /* encoder */
        if (has_encoder)
        {
            /* encoder gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_encoder >= params->reject_limit))
            {
                pendulum_ekf_status_t own = pendulum_ekf_inflate_core(latest, &work[2], params->inflation);
                pendulum_ekf_status_t highest = status;

                if (own >= PENDULUM_EKF_OK)
                {
                    highest = pendulum_ekf_higher(highest, own);
                    own = pendulum_ekf_update_encoder_core(&work[2], spare, params, encoder, 0.0f, &out->encoder);
                }
                out->status_encoder = own;
                if (own >= PENDULUM_EKF_OK)
                {
                    pendulum_ekf_state_t *const taken = spare;

                    spare = latest;
                    latest = taken;
                    status = pendulum_ekf_higher(highest, own);
                    status = pendulum_ekf_higher(status, PENDULUM_EKF_RECOVERED);
                }
                else
                {
                    out->encoder.innovation = 0.0f;
                    out->encoder.variance = 0.0f;
                    out->encoder.nis = 0.0f;
                    status = pendulum_ekf_higher(status, PENDULUM_EKF_SKIPPED);
                }
            }
            else
            {
                pendulum_ekf_status_t own = pendulum_ekf_update_encoder_core(latest, spare, params, encoder,
                    params->gate_encoder, &out->encoder);

                out->status_encoder = own;
                if (own >= PENDULUM_EKF_OK)
                {
                    pendulum_ekf_state_t *const taken = spare;

                    spare = latest;
                    latest = taken;
                    status = pendulum_ekf_higher(status, own);
                }
                else
                {
                    out->encoder.innovation = 0.0f;
                    out->encoder.variance = 0.0f;
                    out->encoder.nis = 0.0f;
                    status = pendulum_ekf_higher(status, PENDULUM_EKF_SKIPPED);
                }
            }
        }
        else
        {
            out->encoder.innovation = 0.0f;
            out->encoder.variance = 0.0f;
            out->encoder.nis = 0.0f;
            out->status_encoder = PENDULUM_EKF_OK;
        }
        *after = *latest;
    }
    return status;
}

pendulum_ekf_status_t pendulum_ekf_init(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params)
{
    pendulum_ekf_state_t after;
    const pendulum_ekf_status_t status = pendulum_ekf_init_core(&after, params);

    if (status >= PENDULUM_EKF_OK)
    {
        *state = after;
    }
    return status;
}

pendulum_ekf_status_t pendulum_ekf_predict(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                           const pendulum_ekf_predict_in_t *in)
{
    pendulum_ekf_state_t after;
    const pendulum_ekf_status_t status = pendulum_ekf_predict_core(state, &after, params, in->torque, in->dt);

    if (status >= PENDULUM_EKF_OK)
    {
        *state = after;
    }
    return status;
}

pendulum_ekf_status_t pendulum_ekf_update_encoder(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                                  const pendulum_ekf_update_encoder_in_t *in,
                                                  pendulum_ekf_update_encoder_out_t *out)
{
    pendulum_ekf_state_t after;
    pendulum_ekf_update_encoder_out_t answer;
    const pendulum_ekf_status_t status = pendulum_ekf_update_encoder_core(state, &after, params, in->encoder,
        params->gate_encoder, &answer);

    if (status >= PENDULUM_EKF_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

pendulum_ekf_status_t pendulum_ekf_step(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                        const pendulum_ekf_step_in_t *in, pendulum_ekf_step_out_t *out)
{
    pendulum_ekf_step_out_t answer;
    const pendulum_ekf_status_t status = pendulum_ekf_step_core(state, state, params, in->torque, in->dt,
        in->has_encoder, in->encoder, &answer);

    if (status >= PENDULUM_EKF_OK)
    {
        *out = answer;
    }
    return status;
}

pendulum_ekf_status_t pendulum_ekf_inflate(pendulum_ekf_state_t *state, const pendulum_ekf_params_t *params,
                                           const pendulum_ekf_inflate_in_t *in)
{
    pendulum_ekf_state_t after;
    const pendulum_ekf_status_t status = pendulum_ekf_inflate_core(state, &after, in->factor);

    (void)params;

    if (status >= PENDULUM_EKF_OK)
    {
        *state = after;
    }
    return status;
}

const char *pendulum_ekf_model(void)
{
    return "ac32d234";
}

const char *pendulum_ekf_status_text(pendulum_ekf_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case PENDULUM_EKF_OK:
            text = "ok";
            break;
        case PENDULUM_EKF_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case PENDULUM_EKF_CLAMPED:
            text = "a variance was held at its ceiling or floor";
            break;
        case PENDULUM_EKF_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case PENDULUM_EKF_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case PENDULUM_EKF_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case PENDULUM_EKF_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case PENDULUM_EKF_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case PENDULUM_EKF_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
