/* pendulum_ekf: see pendulum_ekf.h. Written by plantc 0.1.0 from model 65098682. */
#include "pendulum_ekf.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "pendulum_ekf checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static pendulum_ekf_status_t pendulum_ekf_higher(pendulum_ekf_status_t first, pendulum_ekf_status_t second)
{
    return (first > second) ? first : second;
}

/* Mathematics of plantc's own: no sin, exp ... of a C library is called. It takes + - * /, square roots, comparisons
    and
 * exact conversions only, and so gives the same bits on every machine where the FPU rounds to nearest, keeps denormals
 * and NaN (no flush to zero, no default NaN), and products are not fused with sums (-ffp-contract=off). */

/* (sin(x) - x) / x^3 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float pendulum_ekf_math_sin_series(float z)
{
    float sum = 2.7249926e-6f;

    sum = -0.00019840087f + (z * sum);
    sum = 0.008333332f + (z * sum);
    sum = -0.16666667f + (z * sum);
    return sum;
}

/* (cos(x) - 1 + x^2/2) / x^4 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float pendulum_ekf_math_cos_series(float z)
{
    float sum = 0.000024547942f;

    sum = -0.0013888302f + (z * sum);
    sum = 0.041666664f + (z * sum);
    return sum;
}

/* |x| = quadrant pi/2 + remainder[0] + remainder[1], for |x| <= 1073741824: |x| 2/pi in fixed point, of which 62 bits
 * are behind the point. The quadrant is modulo 4. */
static uint32_t pendulum_ekf_math_reduce(float magnitude, float remainder[2])
{
    const uint64_t half = 0x2000000000000000U;
    const uint32_t whole = (uint32_t)magnitude;
    const float behind = (magnitude - (float)whole) * 1.6777216e7f;
    /* always so: a prover wants to see it */
    const uint32_t part = ((behind >= 0.0f) && (behind <= 1.6777215e7f)) ? (uint32_t)behind : 0U;
    const uint64_t upper = ((uint64_t)whole * 0x28be60db9391054aU) + (((uint64_t)whole * 0x7f09d5f4U) >> 32U);
    const uint64_t lower = (((uint64_t)part * 0x28be60dbU) << 8U) + (((uint64_t)part * 0x9391054aU) >> 24U);
    const uint64_t turned = (upper + lower) + half;
    const uint64_t offset = turned & 0x3fffffffffffffffU;
    const uint64_t below = half - offset;
    const uint64_t above = offset - half;
    uint64_t distance = (offset < half) ? below : above;
    float unit = 0.00024414062f;
    uint64_t bits_11;
    uint64_t bits_24;
    uint64_t bits_26;
    float coarse;
    float fine;
    float first;
    float second;
    float sum;
    float rest;

    /* a small remainder is shifted up, so that the eleven bits in front hold the most of it */
    if (distance < 0x800000000000U)
    {
        distance = distance << 14U;
        unit = unit * 0.000061035156f;
    }
    if (distance < 0x40000000000000U)
    {
        distance = distance << 7U;
        unit = unit * 0.0078125f;
    }
    bits_11 = distance >> 50U;
    bits_24 = (distance >> 26U) & 0xffffffU;
    bits_26 = distance & 0x3ffffffU;
    coarse = (float)(uint32_t)bits_11 * unit;
    fine = ((float)(uint32_t)bits_24 + ((float)(uint32_t)bits_26 * 1.4901161e-8f)) * (unit * 5.9604645e-8f);
    first = coarse * 1.5703125f;
    second = (coarse * 0.0004838268f) + (fine * 1.5707964f);
    sum = first + second;
    rest = second - (sum - first);
    remainder[0] = (offset < half) ? -sum : sum;
    remainder[1] = (offset < half) ? -rest : rest;
    return (uint32_t)(turned >> 62U);
}

/* sin(quadrant pi/2 + remainder). */
static float pendulum_ekf_math_turned(uint32_t quadrant, const float remainder[2])
{
    const float r = remainder[0];
    const float z = r * r;
    float value;

    if ((quadrant & 1U) == 0U)
    {
        const float rest = remainder[1] - (remainder[1] * (0.5f * z));

        value = r + (((r * z) * pendulum_ekf_math_sin_series(z)) + rest);
    }
    else
    {
        value = 1.0f - ((z * (0.5f - (z * pendulum_ekf_math_cos_series(z)))) + (r * remainder[1]));
    }
    if ((quadrant & 2U) != 0U)
    {
        value = -value;
    }
    /* always between: a prover wants to see it */
    if (value > 1.0f)
    {
        value = 1.0f;
    }
    if (value < -1.0f)
    {
        value = -1.0f;
    }
    return value;
}

/* sin(x): for |x| <= 1073741824; NaN beyond, and for infinities and NaN.
 * At most 1.5 ulp from the true value. */
static float pendulum_ekf_math_sin(float x)
{
    const float magnitude = fabsf(x);
    float value;

    if ((x >= -0.00012207031f) && (x <= 0.00012207031f))
    {
        value = x;
    }
    else
    {
        if (magnitude <= 0.7853982f)
        {
            const float z = magnitude * magnitude;

            value = magnitude + ((magnitude * z) * pendulum_ekf_math_sin_series(z));
        }
        else if ((magnitude <= 1.0737418e9f) == true)
        {
            float remainder[2];
            const uint32_t quadrant = pendulum_ekf_math_reduce(magnitude, remainder);

            value = pendulum_ekf_math_turned(quadrant, remainder);
        }
        else
        {
            value = NAN;
        }
        if (x < 0.0f)
        {
            value = -value;
        }
    }
    return value;
}

/* cos(x): for |x| <= 1073741824; NaN beyond, and for infinities and NaN.
 * At most 1.5 ulp from the true value. */
static float pendulum_ekf_math_cos(float x)
{
    const float magnitude = fabsf(x);
    float value;

    if (magnitude <= 0.7853982f)
    {
        const float z = magnitude * magnitude;

        value = 1.0f - (z * (0.5f - (z * pendulum_ekf_math_cos_series(z))));
    }
    else if ((magnitude <= 1.0737418e9f) == true)
    {
        float remainder[2];
        const uint32_t quadrant = pendulum_ekf_math_reduce(magnitude, remainder);

        value = pendulum_ekf_math_turned(quadrant + 1U, remainder);
    }
    else
    {
        value = NAN;
    }
    return value;
}

/* Whether every element is within its bounds; false for NaN. A comparison that decides what is stored is written
 * (... == true), from which Frama-C sees that NaN does not pass. */
static bool pendulum_ekf_is_held(const float covariance[3])
{
    bool held = true;

    for (uint32_t i = 0U; (i < 3U) && held; i++)
    {
        held = ((covariance[i] >= -1.0e9f) == true)
               && ((covariance[i] <= 1.0e9f) == true);
    }
    return held
           && ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[2] >= 1.0e-20f) == true);
}

/* Keeps the variances between floor and ceiling; called only when one is outside. Scaling row and column together keeps
 * the matrix positive definite. What lies beside the diagonal is then compared with its bounds. */
static pendulum_ekf_status_t pendulum_ekf_hold_variances(float covariance[3])
{
    pendulum_ekf_status_t status = PENDULUM_EKF_OK;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 2U; i++)
    {
        if (!((covariance[at] >= 0.0f) == true))
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

        if ((covariance[at] > ceiling_i) == true)
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
    if ((status >= PENDULUM_EKF_OK) && (!pendulum_ekf_is_held(covariance)))
    {
        status = PENDULUM_EKF_OVERFLOW;
    }
    return status;
}

/* Whether a covariance is within its bounds beyond doubt. Elements that are small, and whose sum is not far below
 * zero, are not far below zero themselves. False for NaN. */
static bool pendulum_ekf_is_bounded(const float covariance[3])
{
    return ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[2] >= 1.0e-20f) == true)
           && (((covariance[0] + covariance[2]) <= 9.9e8f) == true)
           && ((covariance[1] <= 5.0e8f) == true)
           && ((covariance[1] >= -5.0e8f) == true);
}

static pendulum_ekf_status_t pendulum_ekf_init_core(pendulum_ekf_state_t *after, const pendulum_ekf_params_t *params)
{
    pendulum_ekf_status_t status = PENDULUM_EKF_OK;

    if (!(((params->mass >= 0.001f) == true) && ((params->mass <= 1000.0f) == true)
          && ((params->length >= 0.001f) == true) && ((params->length <= 100.0f) == true)
          && ((params->gravity >= 0.0f) == true) && ((params->gravity <= 100.0f) == true)
          && ((params->density_draught >= 0.0f) == true) && ((params->density_draught <= 1000000.0f) == true)
          && ((params->variance_encoder >= 1.0e-12f) == true) && ((params->variance_encoder <= 1000000.0f) == true)
          && ((params->gate_encoder >= 0.0f) == true) && ((params->gate_encoder <= 1000000.0f) == true)
          && ((params->inflation >= 1.0f) == true) && ((params->inflation <= 1000000.0f) == true)
          && ((params->theta_0 >= -3.1415927f) == true) && ((params->theta_0 <= 3.1415927f) == true)
          && ((params->omega_0 >= -100.0f) == true) && ((params->omega_0 <= 100.0f) == true)
          && ((params->variance_theta_0 >= 1.0e-12f) == true) && ((params->variance_theta_0 <= 1000000.0f) == true)
          && ((params->variance_omega_0 >= 1.0e-12f) == true) && ((params->variance_omega_0 <= 1000000.0f) == true)))
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

    if (!(((torque >= -10.0f) == true) && ((torque <= 10.0f) == true) && ((dt >= 0.00001f) == true)
          && ((dt <= 0.1f) == true)))
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
        after->omega = omega + (dt * ((torque - (v_2 * pendulum_ekf_math_sin(theta))) * v_3));
        const float f_1_0 = -(dt * (v_3 * (v_2 * pendulum_ekf_math_cos(theta))));
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
            if (!(((after->theta >= -3.15f) == true) && ((after->theta <= 3.15f) == true)
                  && ((after->omega >= -100.0f) == true) && ((after->omega <= 100.0f) == true)))
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

    if (!(((encoder >= -1000.0f) == true) && ((encoder <= 1000.0f) == true)))
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

        if (!((row_variance[0] >= 1.0e-20f) == true))
        {
            status = PENDULUM_EKF_NOT_POSITIVE;
        }
        else
        {
            if (!(((nis[0] >= 0.0f) == true) && ((nis[0] <= 1.0e30f) == true)))
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
                        if (!(((after->theta >= -3.15f) == true) && ((after->theta <= 3.15f) == true)
                              && ((after->omega >= -100.0f) == true) && ((after->omega <= 100.0f) == true)))
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

    if (!(((factor >= 1.0f) == true) && ((factor <= 1000000.0f) == true)))
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
    pendulum_ekf_state_t work[2];
    pendulum_ekf_state_t *latest = &work[0];
    pendulum_ekf_state_t *spare = after;
    pendulum_ekf_status_t status = pendulum_ekf_predict_core(before, latest, params, torque, dt);

    if (status >= PENDULUM_EKF_OK)
    {
        /* encoder */
        if (has_encoder)
        {
            /* encoder gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_encoder >= params->reject_limit))
            {
                pendulum_ekf_status_t own = pendulum_ekf_inflate_core(latest, &work[1], params->inflation);
                pendulum_ekf_status_t highest = status;

                if (own >= PENDULUM_EKF_OK)
                {
                    highest = pendulum_ekf_higher(highest, own);
                    own = pendulum_ekf_update_encoder_core(&work[1], spare, params, encoder, 0.0f, &out->encoder);
                }
                out->status_encoder = own;
                if (own >= PENDULUM_EKF_OK)
                {
                    latest = spare;
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
                    latest = spare;
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
        if (latest != after)
        {
            *after = *latest;
        }
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

/* The hash of the model, as in the header. */
const char *pendulum_ekf_model(void)
{
    return "65098682";
}

/* A sentence for a status. */
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
            text = "a value (a variance, a command) was held at its limit";
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
