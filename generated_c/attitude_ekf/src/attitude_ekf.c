/* attitude_ekf: see attitude_ekf.h. Written by plantc 0.1.0 from model dc394edc. */
#include "attitude_ekf.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "attitude_ekf checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static attitude_ekf_status_t attitude_ekf_higher(attitude_ekf_status_t first, attitude_ekf_status_t second)
{
    return (first > second) ? first : second;
}

/* Mathematics of plantc's own: no sin, exp ... of a C library is called. It takes + - * /, square roots, comparisons
    and
 * exact conversions only, and so gives the same bits on every machine where the FPU rounds to nearest, keeps denormals
 * and NaN (no flush to zero, no default NaN), and products are not fused with sums (-ffp-contract=off). */

/* (sin(x) - x) / x^3 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float attitude_ekf_math_sin_series(float z)
{
    float sum = 2.7249926e-6f;

    sum = -0.00019840087f + (z * sum);
    sum = 0.008333332f + (z * sum);
    sum = -0.16666667f + (z * sum);
    return sum;
}

/* (cos(x) - 1 + x^2/2) / x^4 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float attitude_ekf_math_cos_series(float z)
{
    float sum = 0.000024547942f;

    sum = -0.0013888302f + (z * sum);
    sum = 0.041666664f + (z * sum);
    return sum;
}

/* |x| = quadrant pi/2 + remainder[0] + remainder[1], for |x| <= 1073741824: |x| 2/pi in fixed point, of which 62 bits
 * are behind the point. The quadrant is modulo 4. */
static uint32_t attitude_ekf_math_reduce(float magnitude, float remainder[2])
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
static float attitude_ekf_math_turned(uint32_t quadrant, const float remainder[2])
{
    const float r = remainder[0];
    const float z = r * r;
    float value;

    if ((quadrant & 1U) == 0U)
    {
        const float rest = remainder[1] - (remainder[1] * (0.5f * z));

        value = r + (((r * z) * attitude_ekf_math_sin_series(z)) + rest);
    }
    else
    {
        value = 1.0f - ((z * (0.5f - (z * attitude_ekf_math_cos_series(z)))) + (r * remainder[1]));
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
static float attitude_ekf_math_sin(float x)
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

            value = magnitude + ((magnitude * z) * attitude_ekf_math_sin_series(z));
        }
        else if ((magnitude <= 1.0737418e9f) == true)
        {
            float remainder[2];
            const uint32_t quadrant = attitude_ekf_math_reduce(magnitude, remainder);

            value = attitude_ekf_math_turned(quadrant, remainder);
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
static float attitude_ekf_math_cos(float x)
{
    const float magnitude = fabsf(x);
    float value;

    if (magnitude <= 0.7853982f)
    {
        const float z = magnitude * magnitude;

        value = 1.0f - (z * (0.5f - (z * attitude_ekf_math_cos_series(z))));
    }
    else if ((magnitude <= 1.0737418e9f) == true)
    {
        float remainder[2];
        const uint32_t quadrant = attitude_ekf_math_reduce(magnitude, remainder);

        value = attitude_ekf_math_turned(quadrant + 1U, remainder);
    }
    else
    {
        value = NAN;
    }
    return value;
}

/* Whether every element is within its bounds; false for NaN. A comparison that decides what is stored is written
 * (... == true), from which Frama-C sees that NaN does not pass. */
static bool attitude_ekf_is_held(const float covariance[21])
{
    static const float limit[21] = {
        10.0f, 10.0f, 10.0f, 3.1622777f, 3.1622777f, 3.1622777f,
        10.0f, 10.0f, 3.1622777f, 3.1622777f, 3.1622777f, 10.0f,
        3.1622777f, 3.1622777f, 3.1622777f, 1.0f, 1.0f, 1.0f,
        1.0f, 1.0f, 1.0f
    };
    bool held = true;

    for (uint32_t i = 0U; (i < 21U) && held; i++)
    {
        held = ((covariance[i] >= -limit[i]) == true)
               && ((covariance[i] <= limit[i]) == true);
    }
    return held
           && ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[6] >= 1.0e-20f) == true)
           && ((covariance[11] >= 1.0e-20f) == true)
           && ((covariance[15] >= 1.0e-20f) == true)
           && ((covariance[18] >= 1.0e-20f) == true)
           && ((covariance[20] >= 1.0e-20f) == true);
}

/* Keeps the variances between floor and ceiling; called only when one is outside. Scaling row and column together keeps
 * the matrix positive definite. What lies beside the diagonal is then compared with its bounds. */
static attitude_ekf_status_t attitude_ekf_hold_variances(float covariance[21])
{
    static const float lowest[6] = { 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f };
    static const float highest[6] = { 10.0f, 10.0f, 10.0f, 1.0f, 1.0f, 1.0f };
    attitude_ekf_status_t status = ATTITUDE_EKF_OK;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 6U; i++)
    {
        if (!((covariance[at] >= 0.0f) == true))
        {
            status = ATTITUDE_EKF_NOT_POSITIVE;
        }
        at = at + (6U - i);
    }
    at = 0U;
    for (uint32_t i = 0U; (i < 6U) && (status >= ATTITUDE_EKF_OK); i++)
    {
        const float floor_i = lowest[i];
        const float ceiling_i = highest[i];

        if ((covariance[at] > ceiling_i) == true)
        {
            const float factor = sqrtf(ceiling_i / covariance[at]);
            uint32_t other = i;

            for (uint32_t j = 0U; j < i; j++)
            {
                covariance[other] = covariance[other] * factor;
                other = other + ((6U - 1U) - j);
            }
            for (uint32_t j = i + 1U; j < 6U; j++)
            {
                covariance[at + (j - i)] = covariance[at + (j - i)] * factor;
            }
            covariance[at] = ceiling_i;
            status = ATTITUDE_EKF_CLAMPED;
        }
        else if (covariance[at] < floor_i)
        {
            covariance[at] = floor_i;
            status = ATTITUDE_EKF_CLAMPED;
        }
        else
        {
            /* within its bounds */
        }
        at = at + (6U - i);
    }
    if ((status >= ATTITUDE_EKF_OK) && (!attitude_ekf_is_held(covariance)))
    {
        status = ATTITUDE_EKF_OVERFLOW;
    }
    return status;
}

/* Whether a covariance is within its bounds beyond doubt. Elements that are small, and whose sum is not far below
 * zero, are not far below zero themselves. False for NaN. */
static bool attitude_ekf_is_bounded(const float covariance[21])
{
    return ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[6] >= 1.0e-20f) == true)
           && ((covariance[11] >= 1.0e-20f) == true)
           && ((covariance[15] >= 1.0e-20f) == true)
           && ((covariance[18] >= 1.0e-20f) == true)
           && ((covariance[20] >= 1.0e-20f) == true)
           && ((((covariance[0] + covariance[6]) + covariance[11]) <= 9.9f) == true)
           && ((((covariance[15] + covariance[18]) + covariance[20]) <= 0.99f) == true)
           && ((covariance[1] <= 1.6f) == true)
           && ((covariance[2] <= 1.6f) == true)
           && ((covariance[7] <= 1.6f) == true)
           && ((((covariance[1] + covariance[2]) + covariance[7]) >= -5.0f) == true)
           && ((covariance[3] <= 0.19f) == true)
           && ((covariance[4] <= 0.19f) == true)
           && ((covariance[5] <= 0.19f) == true)
           && ((covariance[8] <= 0.19f) == true)
           && ((covariance[9] <= 0.19f) == true)
           && ((covariance[10] <= 0.19f) == true)
           && ((covariance[12] <= 0.19f) == true)
           && ((covariance[13] <= 0.19f) == true)
           && (((((((((covariance[3] + covariance[4]) + covariance[5]) + covariance[8]) + covariance[9]) +
               covariance[10]) + covariance[12]) + covariance[13]) >= -1.5f) == true)
           && ((covariance[14] <= 1.5f) == true)
           && ((covariance[14] >= -1.5f) == true)
           && ((covariance[16] <= 0.16f) == true)
           && ((covariance[17] <= 0.16f) == true)
           && ((covariance[19] <= 0.16f) == true)
           && ((((covariance[16] + covariance[17]) + covariance[19]) >= -0.5f) == true);
}

/* 4 additions, 8 multiplications, 1 division, sqrtf. */
static attitude_ekf_status_t attitude_ekf_init_core(attitude_ekf_state_t *after, const attitude_ekf_params_t *params)
{
    attitude_ekf_status_t status = ATTITUDE_EKF_OK;

    if (!(((params->field_north >= 0.0f) == true) && ((params->field_north <= 1.0f) == true)
          && ((params->field_down >= -1.0f) == true) && ((params->field_down <= 1.0f) == true)
          && ((params->density_gyro_noise[0] >= 0.0f) == true)
          && ((params->density_gyro_noise[0] <= 1000000.0f) == true)
          && ((params->density_gyro_noise[1] >= 0.0f) == true)
          && ((params->density_gyro_noise[1] <= 1000000.0f) == true)
          && ((params->density_gyro_noise[2] >= 0.0f) == true)
          && ((params->density_gyro_noise[2] <= 1000000.0f) == true) && ((params->density_bias_walk[0] >= 0.0f) == true)
          && ((params->density_bias_walk[0] <= 1000000.0f) == true) && ((params->density_bias_walk[1] >= 0.0f) == true)
          && ((params->density_bias_walk[1] <= 1000000.0f) == true) && ((params->density_bias_walk[2] >= 0.0f) == true)
          && ((params->density_bias_walk[2] <= 1000000.0f) == true) && ((params->gate_accelerometer >= 0.0f) == true)
          && ((params->gate_accelerometer <= 1000000.0f) == true)
          && ((params->variance_magnetometer[0] >= 1.0e-12f) == true)
          && ((params->variance_magnetometer[0] <= 1000000.0f) == true)
          && ((params->variance_magnetometer[1] >= 1.0e-12f) == true)
          && ((params->variance_magnetometer[1] <= 1000000.0f) == true)
          && ((params->variance_magnetometer[2] >= 1.0e-12f) == true)
          && ((params->variance_magnetometer[2] <= 1000000.0f) == true) && ((params->gate_magnetometer >= 0.0f) == true)
          && ((params->gate_magnetometer <= 1000000.0f) == true) && ((params->inflation >= 1.0f) == true)
          && ((params->inflation <= 1000000.0f) == true) && ((params->q_0[0] >= -1.01f) == true)
          && ((params->q_0[0] <= 1.01f) == true) && ((params->q_0[1] >= -1.01f) == true)
          && ((params->q_0[1] <= 1.01f) == true) && ((params->q_0[2] >= -1.01f) == true)
          && ((params->q_0[2] <= 1.01f) == true) && ((params->q_0[3] >= -1.01f) == true)
          && ((params->q_0[3] <= 1.01f) == true) && ((params->bias_0[0] >= -1.0f) == true)
          && ((params->bias_0[0] <= 1.0f) == true) && ((params->bias_0[1] >= -1.0f) == true)
          && ((params->bias_0[1] <= 1.0f) == true) && ((params->bias_0[2] >= -1.0f) == true)
          && ((params->bias_0[2] <= 1.0f) == true) && ((params->variance_q_0[0] >= 1.0e-12f) == true)
          && ((params->variance_q_0[0] <= 1000000.0f) == true) && ((params->variance_q_0[1] >= 1.0e-12f) == true)
          && ((params->variance_q_0[1] <= 1000000.0f) == true) && ((params->variance_q_0[2] >= 1.0e-12f) == true)
          && ((params->variance_q_0[2] <= 1000000.0f) == true) && ((params->variance_bias_0[0] >= 1.0e-12f) == true)
          && ((params->variance_bias_0[0] <= 1000000.0f) == true) && ((params->variance_bias_0[1] >= 1.0e-12f) == true)
          && ((params->variance_bias_0[1] <= 1000000.0f) == true) && ((params->variance_bias_0[2] >= 1.0e-12f) == true)
          && ((params->variance_bias_0[2] <= 1000000.0f) == true)))
    {
        status = ATTITUDE_EKF_BAD_PARAM;
    }
    else
    {
        /* q = q_0 scaled to unit length, from which it may be 1 % away */
        const float q_0_0 = params->q_0[0];
        const float q_0_1 = params->q_0[1];
        const float q_0_2 = params->q_0[2];
        const float q_0_3 = params->q_0[3];
        const float square_q = (((q_0_0 * q_0_0) + (q_0_1 * q_0_1)) + (q_0_2 * q_0_2)) + (q_0_3 * q_0_3);
        const float v = 1.0f / sqrtf(square_q + 1.0e-20f);
        after->q[0] = q_0_0 * v;
        after->q[1] = q_0_1 * v;
        after->q[2] = q_0_2 * v;
        after->q[3] = q_0_3 * v;

        if (!(((square_q >= 0.98f) == true) && ((square_q <= 1.02f) == true)))
        {
            status = ATTITUDE_EKF_BAD_PARAM;
        }
        else
        {
            after->bias[0] = params->bias_0[0];
            after->bias[1] = params->bias_0[1];
            after->bias[2] = params->bias_0[2];
            for (uint32_t i = 0U; i < 21U; i++)
            {
                after->covariance[i] = 0.0f;
            }
            after->covariance[0] = params->variance_q_0[0];
            after->covariance[6] = params->variance_q_0[1];
            after->covariance[11] = params->variance_q_0[2];
            after->covariance[15] = params->variance_bias_0[0];
            after->covariance[18] = params->variance_bias_0[1];
            after->covariance[20] = params->variance_bias_0[2];
            after->rejected_accelerometer = 0U;
            after->rejected_magnetometer = 0U;

            /* judge, then commit */
            if (!attitude_ekf_is_bounded(after->covariance))
            {
                status = attitude_ekf_hold_variances(after->covariance);
            }
            if (status >= ATTITUDE_EKF_OK)
            {
                if (!(((after->q[0] >= -1.01f) == true) && ((after->q[0] <= 1.01f) == true)
                      && ((after->q[1] >= -1.01f) == true) && ((after->q[1] <= 1.01f) == true)
                      && ((after->q[2] >= -1.01f) == true) && ((after->q[2] <= 1.01f) == true)
                      && ((after->q[3] >= -1.01f) == true) && ((after->q[3] <= 1.01f) == true)
                      && ((after->bias[0] >= -1.0f) == true) && ((after->bias[0] <= 1.0f) == true)
                      && ((after->bias[1] >= -1.0f) == true) && ((after->bias[1] <= 1.0f) == true)
                      && ((after->bias[2] >= -1.0f) == true) && ((after->bias[2] <= 1.0f) == true)))
                {
                    status = ATTITUDE_EKF_OVERFLOW;
                }
            }
        }
    }
    return status;
}

/* 227 additions, 328 multiplications, 1 division, 12 negations, cosf, sinf, sqrtf. */
static attitude_ekf_status_t attitude_ekf_predict_core(const attitude_ekf_state_t *before, attitude_ekf_state_t *after,
                                                       const attitude_ekf_params_t *params, const float gyro[3],
                                                       const float dt)
{
    attitude_ekf_status_t status = ATTITUDE_EKF_OK;

    after->rejected_accelerometer = before->rejected_accelerometer;
    after->rejected_magnetometer = before->rejected_magnetometer;

    if (!(((gyro[0] >= -40.0f) == true) && ((gyro[0] <= 40.0f) == true) && ((gyro[1] >= -40.0f) == true)
          && ((gyro[1] <= 40.0f) == true) && ((gyro[2] >= -40.0f) == true) && ((gyro[2] <= 40.0f) == true)
          && ((dt >= 0.0001f) == true) && ((dt <= 0.1f) == true)))
    {
        status = ATTITUDE_EKF_BAD_INPUT;
    }
    else
    {
        /* x, F = dx/dx and Q over one step, by euler */
        /* rate of q[0] = gyro[0] - bias[0] + gyro_noise[0] */
        /* rate of q[1] = gyro[1] - bias[1] + gyro_noise[1] */
        /* rate of q[2] = gyro[2] - bias[2] + gyro_noise[2] */
        /* bias[0]' = bias_walk[0] */
        /* bias[1]' = bias_walk[1] */
        /* bias[2]' = bias_walk[2] */
        const float q_0 = before->q[0];
        const float bias_0 = before->bias[0];
        const float v = gyro[0] - bias_0;
        const float v_2 = dt * v;
        const float bias_1 = before->bias[1];
        const float v_3 = gyro[1] - bias_1;
        const float v_4 = dt * v_3;
        const float bias_2 = before->bias[2];
        const float v_5 = gyro[2] - bias_2;
        const float v_6 = dt * v_5;
        const float v_7 = sqrtf((((v_2 * v_2) + (v_4 * v_4)) + (v_6 * v_6)) + 1.0e-20f);
        const float v_8 = 0.5f * v_7;
        const float v_9 = attitude_ekf_math_cos(v_8);
        const float q_1 = before->q[1];
        const float v_10 = attitude_ekf_math_sin(v_8);
        const float v_11 = 1.0f / v_7;
        const float v_12 = v_10 * v_11;
        const float v_13 = v_2 * v_12;
        const float q_2 = before->q[2];
        const float v_14 = v_4 * v_12;
        const float q_3 = before->q[3];
        const float v_15 = v_6 * v_12;
        const float v_16 = (((q_0 * v_9) - (q_1 * v_13)) - (q_2 * v_14)) - (q_3 * v_15);
        const float v_17 = (((q_0 * v_13) + (q_1 * v_9)) + (q_2 * v_15)) - (q_3 * v_14);
        const float v_18 = (((q_0 * v_14) - (q_1 * v_15)) + (q_2 * v_9)) + (q_3 * v_13);
        const float v_19 = (((q_0 * v_15) + (q_1 * v_14)) - (q_2 * v_13)) + (q_3 * v_9);
        const float v_20 = 1.5f - (0.5f * ((((v_16 * v_16) + (v_17 * v_17)) + (v_18 * v_18)) + (v_19 * v_19)));
        after->q[0] = v_16 * v_20;
        after->q[1] = v_17 * v_20;
        after->q[2] = v_18 * v_20;
        after->q[3] = v_19 * v_20;
        after->bias[0] = bias_0;
        after->bias[1] = bias_1;
        after->bias[2] = bias_2;
        const float v_21 = 0.5f * v_9;
        const float v_22 = v_9 * v_21;
        const float v_23 = 0.5f * v_13;
        const float v_24 = v_13 * v_23;
        const float v_25 = 0.5f * v_14;
        const float v_26 = v_14 * v_25;
        const float v_27 = 0.5f * v_15;
        const float v_28 = v_15 * v_27;
        const float f_0_0 = (((v_22 + v_24) - v_26) - v_28) * 2.0f;
        const float v_29 = v_9 * v_27;
        const float v_30 = v_13 * v_25;
        const float v_31 = v_14 * v_23;
        const float v_32 = v_15 * v_21;
        const float f_0_1 = 2.0f * (((v_29 + v_30) + v_31) + v_32);
        const float v_33 = v_13 * v_27;
        const float v_34 = v_9 * v_25;
        const float v_35 = v_14 * v_21;
        const float v_36 = v_15 * v_23;
        const float f_0_2 = 2.0f * (((v_33 - v_34) - v_35) + v_36);
        const float v_37 = v_2 * v_11;
        const float v_38 = 0.5f * v_37;
        const float v_39 = v_11 * v_12;
        const float v_40 = (v_11 * (v_9 * v_38)) - (v_37 * v_39);
        const float v_41 = v_12 + (v_2 * v_40);
        const float v_42 = v_10 * v_38;
        const float v_43 = v_6 * v_40;
        const float v_44 = v_4 * v_40;
        const float f_0_3 = -(dt * (2.0f * ((((v_9 * v_41) + (v_13 * v_42)) - (v_14 * v_43)) + (v_15 * v_44))));
        const float v_45 = v_4 * v_11;
        const float v_46 = 0.5f * v_45;
        const float v_47 = (v_11 * (v_9 * v_46)) - (v_39 * v_45);
        const float v_48 = v_2 * v_47;
        const float v_49 = v_10 * v_46;
        const float v_50 = v_6 * v_47;
        const float v_51 = v_12 + (v_4 * v_47);
        const float f_0_4 = -(dt * (2.0f * ((((v_9 * v_48) + (v_13 * v_49)) - (v_14 * v_50)) + (v_15 * v_51))));
        const float v_52 = v_6 * v_11;
        const float v_53 = 0.5f * v_52;
        const float v_54 = (v_11 * (v_9 * v_53)) - (v_39 * v_52);
        const float v_55 = v_2 * v_54;
        const float v_56 = v_10 * v_53;
        const float v_57 = v_12 + (v_6 * v_54);
        const float v_58 = v_4 * v_54;
        const float f_0_5 = -(dt * (2.0f * ((((v_9 * v_55) + (v_13 * v_56)) - (v_14 * v_57)) + (v_15 * v_58))));
        const float f_1_0 = 2.0f * ((v_31 + (v_30 - v_29)) - v_32);
        const float v_59 = v_22 - v_24;
        const float f_1_1 = 2.0f * ((v_26 + v_59) - v_28);
        const float v_60 = (v_9 * v_23) + (v_13 * v_21);
        const float v_61 = v_14 * v_27;
        const float v_62 = v_15 * v_25;
        const float f_1_2 = 2.0f * ((v_60 + v_61) + v_62);
        const float f_1_3 = -(dt * (2.0f * ((((v_9 * v_44) + (v_13 * v_43)) + (v_14 * v_42)) - (v_15 * v_41))));
        const float f_1_4 = -(dt * (2.0f * ((((v_9 * v_51) + (v_13 * v_50)) + (v_14 * v_49)) - (v_15 * v_48))));
        const float f_1_5 = -(dt * (2.0f * ((((v_9 * v_58) + (v_13 * v_57)) + (v_14 * v_56)) - (v_15 * v_55))));
        const float f_2_0 = 2.0f * (v_36 + (v_35 + (v_33 + v_34)));
        const float f_2_1 = 2.0f * (v_62 + (v_61 - v_60));
        const float f_2_2 = 2.0f * (v_28 + (v_59 - v_26));
        const float f_2_3 = -(dt * (2.0f * ((((v_9 * v_43) - (v_13 * v_44)) + (v_14 * v_41)) + (v_15 * v_42))));
        const float f_2_4 = -(dt * (2.0f * ((((v_9 * v_50) - (v_13 * v_51)) + (v_14 * v_48)) + (v_15 * v_49))));
        const float f_2_5 = -(dt * (2.0f * ((((v_9 * v_57) - (v_13 * v_58)) + (v_14 * v_55)) + (v_15 * v_56))));
        const float density_gyro_noise_0 = params->density_gyro_noise[0];
        const float density_bias_walk_0 = params->density_bias_walk[0];
        const float density_gyro_noise_1 = params->density_gyro_noise[1];
        const float v_63 = density_gyro_noise_1 * v_5;
        const float density_gyro_noise_2 = params->density_gyro_noise[2];
        const float v_64 = density_gyro_noise_2 * v_3;
        const float v_65 = dt * dt;
        const float v_66 = (dt * v_65) * 0.33333334f;
        const float q_0_0 = (density_gyro_noise_0 * dt) + ((density_bias_walk_0 + ((v_5 * v_63) + (v_3 * v_64))) *
            v_66);
        const float v_67 = density_gyro_noise_0 * v_5;
        const float v_68 = 0.5f * v_65;
        const float q_0_1 = ((v_63 - v_67) * v_68) - (v_66 * (v * v_64));
        const float v_69 = density_gyro_noise_0 * v_3;
        const float q_0_2 = (v_68 * (v_69 - v_64)) - (v_66 * (v * v_63));
        const float q_0_3 = -(density_bias_walk_0 * v_68);
        const float density_bias_walk_1 = params->density_bias_walk[1];
        const float v_70 = density_gyro_noise_2 * v;
        const float q_1_1 = (density_gyro_noise_1 * dt) + (v_66 * (density_bias_walk_1 + ((v_5 * v_67) + (v * v_70))));
        const float v_71 = density_gyro_noise_1 * v;
        const float q_1_2 = (v_68 * (v_70 - v_71)) - (v_66 * (v_3 * v_67));
        const float q_1_4 = -(density_bias_walk_1 * v_68);
        const float density_bias_walk_2 = params->density_bias_walk[2];
        const float q_2_2 = (density_gyro_noise_2 * dt) + (v_66 * (density_bias_walk_2 + ((v_3 * v_69) + (v * v_71))));
        const float q_2_5 = -(density_bias_walk_2 * v_68);
        const float q_3_3 = density_bias_walk_0 * dt;
        const float q_4_4 = density_bias_walk_1 * dt;
        const float q_5_5 = density_bias_walk_2 * dt;

        /* P = F P F' + Q */
        {
            const float p_5_5 = before->covariance[20];
            const float p_4_5 = before->covariance[19];
            const float p_3_5 = before->covariance[17];
            const float p_2_5 = before->covariance[14];
            const float p_0_5 = before->covariance[5];
            const float p_1_5 = before->covariance[10];
            const float v_72 = (f_0_4 * p_4_5) + ((f_0_3 * p_3_5) + ((f_0_2 * p_2_5) + ((f_0_0 * p_0_5) + (f_0_1 *
                p_1_5))));
            const float v_73 = (f_0_5 * p_5_5) + v_72;
            const float p_4_4 = before->covariance[18];
            const float p_3_4 = before->covariance[16];
            const float p_2_4 = before->covariance[13];
            const float p_0_4 = before->covariance[4];
            const float p_1_4 = before->covariance[9];
            const float v_74 = (f_0_4 * p_4_4) + ((f_0_3 * p_3_4) + ((f_0_2 * p_2_4) + ((f_0_0 * p_0_4) + (f_0_1 *
                p_1_4))));
            const float v_75 = (f_0_5 * p_4_5) + v_74;
            const float p_3_3 = before->covariance[15];
            const float p_2_3 = before->covariance[12];
            const float p_0_3 = before->covariance[3];
            const float p_1_3 = before->covariance[8];
            const float v_76 = (f_0_4 * p_3_4) + ((f_0_3 * p_3_3) + ((f_0_2 * p_2_3) + ((f_0_0 * p_0_3) + (f_0_1 *
                p_1_3))));
            const float v_77 = (f_0_5 * p_3_5) + v_76;
            const float p_2_2 = before->covariance[11];
            const float p_0_2 = before->covariance[2];
            const float p_1_2 = before->covariance[7];
            const float v_78 = (f_0_4 * p_2_4) + ((f_0_3 * p_2_3) + ((f_0_2 * p_2_2) + ((f_0_0 * p_0_2) + (f_0_1 *
                p_1_2))));
            const float v_79 = (f_0_5 * p_2_5) + v_78;
            const float p_0_0 = before->covariance[0];
            const float p_0_1 = before->covariance[1];
            const float v_80 = (f_0_4 * p_0_4) + ((f_0_3 * p_0_3) + ((f_0_2 * p_0_2) + ((f_0_0 * p_0_0) + (f_0_1 *
                p_0_1))));
            const float v_81 = (f_0_5 * p_0_5) + v_80;
            const float p_1_1 = before->covariance[6];
            const float v_82 = (f_0_4 * p_1_4) + ((f_0_3 * p_1_3) + ((f_0_2 * p_1_2) + ((f_0_0 * p_0_1) + (f_0_1 *
                p_1_1))));
            const float v_83 = (f_0_5 * p_1_5) + v_82;
            const float v_84 = (f_0_4 * v_75) + ((f_0_3 * v_77) + ((f_0_2 * v_79) + ((f_0_0 * v_81) + (f_0_1 * v_83))));
            after->covariance[0] = q_0_0 + ((f_0_5 * v_73) + v_84);
            const float v_85 = (f_1_4 * v_75) + ((f_1_3 * v_77) + ((f_1_2 * v_79) + ((f_1_1 * v_83) + (f_1_0 * v_81))));
            after->covariance[1] = q_0_1 + ((f_1_5 * v_73) + v_85);
            const float v_86 = (f_2_4 * v_75) + ((f_2_3 * v_77) + ((f_2_1 * v_83) + ((f_2_2 * v_79) + (f_2_0 * v_81))));
            after->covariance[2] = q_0_2 + ((f_2_5 * v_73) + v_86);
            after->covariance[3] = q_0_3 + v_77;
            after->covariance[4] = v_75;
            after->covariance[5] = v_73;
            const float v_87 = (f_1_4 * p_4_5) + ((f_1_3 * p_3_5) + ((f_1_2 * p_2_5) + ((f_1_1 * p_1_5) + (f_1_0 *
                p_0_5))));
            const float v_88 = (f_1_5 * p_5_5) + v_87;
            const float v_89 = (f_1_4 * p_4_4) + ((f_1_3 * p_3_4) + ((f_1_2 * p_2_4) + ((f_1_1 * p_1_4) + (f_1_0 *
                p_0_4))));
            const float v_90 = (f_1_5 * p_4_5) + v_89;
            const float v_91 = (f_1_4 * p_3_4) + ((f_1_3 * p_3_3) + ((f_1_2 * p_2_3) + ((f_1_1 * p_1_3) + (f_1_0 *
                p_0_3))));
            const float v_92 = (f_1_5 * p_3_5) + v_91;
            const float v_93 = (f_1_4 * p_2_4) + ((f_1_3 * p_2_3) + ((f_1_2 * p_2_2) + ((f_1_1 * p_1_2) + (f_1_0 *
                p_0_2))));
            const float v_94 = (f_1_5 * p_2_5) + v_93;
            const float v_95 = (f_1_4 * p_1_4) + ((f_1_3 * p_1_3) + ((f_1_2 * p_1_2) + ((f_1_1 * p_1_1) + (f_1_0 *
                p_0_1))));
            const float v_96 = (f_1_5 * p_1_5) + v_95;
            const float v_97 = (f_1_4 * p_0_4) + ((f_1_3 * p_0_3) + ((f_1_2 * p_0_2) + ((f_1_1 * p_0_1) + (f_1_0 *
                p_0_0))));
            const float v_98 = (f_1_5 * p_0_5) + v_97;
            const float v_99 = (f_1_4 * v_90) + ((f_1_3 * v_92) + ((f_1_2 * v_94) + ((f_1_1 * v_96) + (f_1_0 * v_98))));
            after->covariance[6] = q_1_1 + ((f_1_5 * v_88) + v_99);
            const float v_100 = (f_2_4 * v_90) + ((f_2_3 * v_92) + ((f_2_1 * v_96) + ((f_2_2 * v_94) + (f_2_0 *
                v_98))));
            after->covariance[7] = q_1_2 + ((f_2_5 * v_88) + v_100);
            after->covariance[8] = v_92;
            after->covariance[9] = q_1_4 + v_90;
            after->covariance[10] = v_88;
            const float v_101 = (f_2_4 * p_4_5) + ((f_2_3 * p_3_5) + ((f_2_1 * p_1_5) + ((f_2_2 * p_2_5) + (f_2_0 *
                p_0_5))));
            const float v_102 = (f_2_5 * p_5_5) + v_101;
            const float v_103 = (f_2_4 * p_4_4) + ((f_2_3 * p_3_4) + ((f_2_1 * p_1_4) + ((f_2_2 * p_2_4) + (f_2_0 *
                p_0_4))));
            const float v_104 = (f_2_5 * p_4_5) + v_103;
            const float v_105 = (f_2_4 * p_3_4) + ((f_2_3 * p_3_3) + ((f_2_1 * p_1_3) + ((f_2_2 * p_2_3) + (f_2_0 *
                p_0_3))));
            const float v_106 = (f_2_5 * p_3_5) + v_105;
            const float v_107 = (f_2_4 * p_1_4) + ((f_2_3 * p_1_3) + ((f_2_1 * p_1_1) + ((f_2_2 * p_1_2) + (f_2_0 *
                p_0_1))));
            const float v_108 = (f_2_4 * p_2_4) + ((f_2_3 * p_2_3) + ((f_2_1 * p_1_2) + ((f_2_2 * p_2_2) + (f_2_0 *
                p_0_2))));
            const float v_109 = (f_2_4 * p_0_4) + ((f_2_3 * p_0_3) + ((f_2_1 * p_0_1) + ((f_2_2 * p_0_2) + (f_2_0 *
                p_0_0))));
            const float v_110 = (f_2_1 * ((f_2_5 * p_1_5) + v_107)) + ((f_2_2 * ((f_2_5 * p_2_5) + v_108)) + (f_2_0 *
                ((f_2_5 * p_0_5) + v_109)));
            after->covariance[11] = q_2_2 + ((f_2_5 * v_102) + ((f_2_4 * v_104) + ((f_2_3 * v_106) + v_110)));
            after->covariance[12] = v_106;
            after->covariance[13] = v_104;
            after->covariance[14] = q_2_5 + v_102;
            after->covariance[15] = q_3_3 + p_3_3;
            after->covariance[16] = p_3_4;
            after->covariance[17] = p_3_5;
            after->covariance[18] = q_4_4 + p_4_4;
            after->covariance[19] = p_4_5;
            after->covariance[20] = q_5_5 + p_5_5;
        }

        /* judge, then commit */
        if (!attitude_ekf_is_bounded(after->covariance))
        {
            status = attitude_ekf_hold_variances(after->covariance);
        }
        if (status >= ATTITUDE_EKF_OK)
        {
            if (!(((after->q[0] >= -1.01f) == true) && ((after->q[0] <= 1.01f) == true)
                  && ((after->q[1] >= -1.01f) == true) && ((after->q[1] <= 1.01f) == true)
                  && ((after->q[2] >= -1.01f) == true) && ((after->q[2] <= 1.01f) == true)
                  && ((after->q[3] >= -1.01f) == true) && ((after->q[3] <= 1.01f) == true)
                  && ((after->bias[0] >= -1.0f) == true) && ((after->bias[0] <= 1.0f) == true)
                  && ((after->bias[1] >= -1.0f) == true) && ((after->bias[1] <= 1.0f) == true)
                  && ((after->bias[2] >= -1.0f) == true) && ((after->bias[2] <= 1.0f) == true)))
            {
                status = ATTITUDE_EKF_OVERFLOW;
            }
        }
    }
    return status;
}

/* 257 additions, 340 multiplications, 4 divisions, 16 negations, 3 selections, cosf, sinf, sqrtf 2 times. */
static attitude_ekf_status_t attitude_ekf_update_accelerometer_core(const attitude_ekf_state_t *before,
                                                                    attitude_ekf_state_t *after,
                                                                    const float accelerometer[3], const float gate,
                                                                    attitude_ekf_update_accelerometer_out_t *out)
{
    float delta[6];
    float nis[1];
    float row_variance[3];
    attitude_ekf_status_t status = ATTITUDE_EKF_OK;

    after->rejected_magnetometer = before->rejected_magnetometer;

    if (!(((accelerometer[0] >= -200.0f) == true) && ((accelerometer[0] <= 200.0f) == true)
          && ((accelerometer[1] >= -200.0f) == true) && ((accelerometer[1] <= 200.0f) == true)
          && ((accelerometer[2] >= -200.0f) == true) && ((accelerometer[2] <= 200.0f) == true)))
    {
        status = ATTITUDE_EKF_BAD_INPUT;
    }
    else
    {
        /* residual[0] = accelerometer[0] - (-19.6133 (q[1] q[3] - q[0] q[2])) */
        /* residual[1] = accelerometer[1] - (-19.6133 (q[2] q[3] + q[0] q[1])) */
        /* residual[2] = accelerometer[2] - (-9.80665 (1 - 2 (q[1]^2 + q[2]^2))) */
        const float q_1 = before->q[1];
        const float q_3 = before->q[3];
        const float q_0 = before->q[0];
        const float q_2 = before->q[2];
        const float residual_0 = accelerometer[0] + (((q_1 * q_3) - (q_0 * q_2)) * 19.6133f);
        const float residual_1 = accelerometer[1] + (19.6133f * ((q_2 * q_3) + (q_0 * q_1)));
        const float residual_2 = accelerometer[2] + ((1.0f - (((q_1 * q_1) + (q_2 * q_2)) * 2.0f)) * 9.80665f);
        const float v = -(q_2 * 19.6133f);
        const float v_2 = q_1 * 0.5f;
        const float v_3 = v * v_2;
        const float v_4 = -(q_3 * 19.6133f);
        const float v_5 = q_0 * 0.5f;
        const float v_6 = v_4 * v_5;
        const float v_7 = -(q_0 * 19.6133f);
        const float v_8 = q_3 * 0.5f;
        const float v_9 = v_7 * v_8;
        const float v_10 = -(q_1 * 19.6133f);
        const float v_11 = q_2 * 0.5f;
        const float v_12 = v_10 * v_11;
        const float h_0_0 = ((v_3 + v_6) - v_9) - v_12;
        const float v_13 = v * v_11;
        const float v_14 = v_4 * v_8;
        const float v_15 = v_5 * v_7;
        const float v_16 = v_2 * v_10;
        const float h_0_1 = ((v_13 - v_14) - v_15) + v_16;
        const float h_0_2 = (((v * v_8) + (v_4 * v_11)) + (v_2 * v_7)) + (v_5 * v_10);
        const float h_1_0 = (v_14 + (v_15 - v_16)) - v_13;
        const float h_1_1 = v_3 + (v_6 - (v_9 + v_12));
        const float h_1_2 = (((v_7 * v_11) - (v_8 * v_10)) - (v_2 * v_4)) + (v * v_5);
        const float v_17 = -(q_1 * 39.2266f);
        const float v_18 = -(q_2 * 39.2266f);
        const float h_2_0 = -((v_5 * v_17) + (v_8 * v_18));
        const float h_2_1 = (v_8 * v_17) - (v_5 * v_18);
        const float h_2_2 = (v_2 * v_18) - (v_11 * v_17);
        const float v_19 = ((accelerometer[0] * accelerometer[0]) + (accelerometer[1] * accelerometer[1])) +
            (accelerometer[2] * accelerometer[2]);
        const float v_20 = 2.0f * (sqrtf(v_19) - 9.80665f);
        const float r_0 = 0.25f + (v_20 * v_20);

        /* variance of the innovation: diagonal of H P H' + R */
        {
            const float p_2_2 = before->covariance[11];
            const float p_0_2 = before->covariance[2];
            const float p_1_2 = before->covariance[7];
            const float p_0_0 = before->covariance[0];
            const float p_0_1 = before->covariance[1];
            const float p_1_1 = before->covariance[6];
            const float v_21 = (h_0_0 * ((h_0_2 * p_0_2) + ((h_0_0 * p_0_0) + (h_0_1 * p_0_1)))) + (h_0_1 * ((h_0_2 *
                p_1_2) + ((h_0_0 * p_0_1) + (h_0_1 * p_1_1))));
            out->variance[0] = r_0 + ((h_0_2 * ((h_0_2 * p_2_2) + ((h_0_0 * p_0_2) + (h_0_1 * p_1_2)))) + v_21);
            const float v_22 = (h_1_0 * ((h_1_2 * p_0_2) + ((h_1_0 * p_0_0) + (h_1_1 * p_0_1)))) + (h_1_1 * ((h_1_2 *
                p_1_2) + ((h_1_0 * p_0_1) + (h_1_1 * p_1_1))));
            out->variance[1] = r_0 + ((h_1_2 * ((h_1_2 * p_2_2) + ((h_1_0 * p_0_2) + (h_1_1 * p_1_2)))) + v_22);
            const float v_23 = (h_2_0 * ((h_2_2 * p_0_2) + ((h_2_0 * p_0_0) + (h_2_1 * p_0_1)))) + (h_2_1 * ((h_2_2 *
                p_1_2) + ((h_2_0 * p_0_1) + (h_2_1 * p_1_1))));
            out->variance[2] = r_0 + ((h_2_2 * ((h_2_2 * p_2_2) + ((h_2_0 * p_0_2) + (h_2_1 * p_1_2)))) + v_23);
        }
        out->innovation[0] = residual_0;
        out->innovation[1] = residual_1;
        out->innovation[2] = residual_2;

        /* row 0: d = d + K e, P = P - K s K' */
        /* row 1: d = d + K e, P = P - K s K' */
        /* row 2: d = d + K e, P = P - K s K' */
        {
            const float p_0_0 = before->covariance[0];
            const float p_0_2 = before->covariance[2];
            const float p_0_1 = before->covariance[1];
            const float v_21 = (h_0_2 * p_0_2) + ((h_0_0 * p_0_0) + (h_0_1 * p_0_1));
            const float p_2_2 = before->covariance[11];
            const float p_1_2 = before->covariance[7];
            const float v_22 = (h_0_2 * p_2_2) + ((h_0_0 * p_0_2) + (h_0_1 * p_1_2));
            const float p_1_1 = before->covariance[6];
            const float v_23 = (h_0_2 * p_1_2) + ((h_0_0 * p_0_1) + (h_0_1 * p_1_1));
            const float s = r_0 + ((h_0_2 * v_22) + ((h_0_0 * v_21) + (h_0_1 * v_23)));
            const float per_s = 1.0f / ((s >= 1.0e-20f) ? s : 1.0f);
            const float minus_per_s = -per_s;
            const float n_0 = v_21 * minus_per_s;
            const float v_24 = p_0_0 + (v_21 * n_0);
            const float v_25 = p_0_2 + (v_22 * n_0);
            const float v_26 = p_0_1 + (v_23 * n_0);
            const float v_27 = (h_1_2 * v_25) + ((h_1_0 * v_24) + (h_1_1 * v_26));
            const float n_2 = v_22 * minus_per_s;
            const float v_28 = p_2_2 + (v_22 * n_2);
            const float n_1 = v_23 * minus_per_s;
            const float v_29 = p_1_2 + (v_22 * n_1);
            const float v_30 = (h_1_2 * v_28) + ((h_1_0 * v_25) + (h_1_1 * v_29));
            const float v_31 = p_1_1 + (v_23 * n_1);
            const float v_32 = (h_1_2 * v_29) + ((h_1_0 * v_26) + (h_1_1 * v_31));
            const float s_2 = r_0 + ((h_1_2 * v_30) + ((h_1_0 * v_27) + (h_1_1 * v_32)));
            const float per_s_2 = 1.0f / ((s_2 >= 1.0e-20f) ? s_2 : 1.0f);
            const float minus_per_s_2 = -per_s_2;
            const float n_0_2 = v_27 * minus_per_s_2;
            const float v_33 = v_24 + (v_27 * n_0_2);
            const float v_34 = v_25 + (v_30 * n_0_2);
            const float v_35 = v_26 + (v_32 * n_0_2);
            const float v_36 = (h_2_2 * v_34) + ((h_2_0 * v_33) + (h_2_1 * v_35));
            const float n_2_2 = v_30 * minus_per_s_2;
            const float v_37 = v_28 + (v_30 * n_2_2);
            const float n_1_2 = v_32 * minus_per_s_2;
            const float v_38 = v_29 + (v_30 * n_1_2);
            const float v_39 = (h_2_2 * v_37) + ((h_2_0 * v_34) + (h_2_1 * v_38));
            const float v_40 = v_31 + (v_32 * n_1_2);
            const float v_41 = (h_2_2 * v_38) + ((h_2_0 * v_35) + (h_2_1 * v_40));
            const float s_3 = r_0 + ((h_2_2 * v_39) + ((h_2_0 * v_36) + (h_2_1 * v_41)));
            const float per_s_3 = 1.0f / ((s_3 >= 1.0e-20f) ? s_3 : 1.0f);
            const float minus_per_s_3 = -per_s_3;
            const float n_0_3 = v_36 * minus_per_s_3;
            after->covariance[0] = v_33 + (v_36 * n_0_3);
            after->covariance[1] = v_35 + (v_41 * n_0_3);
            after->covariance[2] = v_34 + (v_39 * n_0_3);
            const float p_0_3 = before->covariance[3];
            const float p_2_3 = before->covariance[12];
            const float p_1_3 = before->covariance[8];
            const float v_42 = (h_0_2 * p_2_3) + ((h_0_0 * p_0_3) + (h_0_1 * p_1_3));
            const float v_43 = p_0_3 + (v_42 * n_0);
            const float v_44 = p_2_3 + (v_42 * n_2);
            const float v_45 = p_1_3 + (v_42 * n_1);
            const float v_46 = (h_1_2 * v_44) + ((h_1_0 * v_43) + (h_1_1 * v_45));
            const float v_47 = v_43 + (v_46 * n_0_2);
            const float v_48 = v_44 + (v_46 * n_2_2);
            const float v_49 = v_45 + (v_46 * n_1_2);
            const float v_50 = (h_2_2 * v_48) + ((h_2_0 * v_47) + (h_2_1 * v_49));
            after->covariance[3] = v_47 + (v_50 * n_0_3);
            const float p_0_4 = before->covariance[4];
            const float p_2_4 = before->covariance[13];
            const float p_1_4 = before->covariance[9];
            const float v_51 = (h_0_2 * p_2_4) + ((h_0_0 * p_0_4) + (h_0_1 * p_1_4));
            const float v_52 = p_0_4 + (v_51 * n_0);
            const float v_53 = p_2_4 + (v_51 * n_2);
            const float v_54 = p_1_4 + (v_51 * n_1);
            const float v_55 = (h_1_2 * v_53) + ((h_1_0 * v_52) + (h_1_1 * v_54));
            const float v_56 = v_52 + (v_55 * n_0_2);
            const float v_57 = v_53 + (v_55 * n_2_2);
            const float v_58 = v_54 + (v_55 * n_1_2);
            const float v_59 = (h_2_2 * v_57) + ((h_2_0 * v_56) + (h_2_1 * v_58));
            after->covariance[4] = v_56 + (v_59 * n_0_3);
            const float p_0_5 = before->covariance[5];
            const float p_2_5 = before->covariance[14];
            const float p_1_5 = before->covariance[10];
            const float v_60 = (h_0_2 * p_2_5) + ((h_0_0 * p_0_5) + (h_0_1 * p_1_5));
            const float v_61 = p_0_5 + (v_60 * n_0);
            const float v_62 = p_2_5 + (v_60 * n_2);
            const float v_63 = p_1_5 + (v_60 * n_1);
            const float v_64 = (h_1_2 * v_62) + ((h_1_0 * v_61) + (h_1_1 * v_63));
            const float v_65 = v_61 + (v_64 * n_0_2);
            const float v_66 = v_62 + (v_64 * n_2_2);
            const float v_67 = v_63 + (v_64 * n_1_2);
            const float v_68 = (h_2_2 * v_66) + ((h_2_0 * v_65) + (h_2_1 * v_67));
            after->covariance[5] = v_65 + (v_68 * n_0_3);
            const float n_1_3 = v_41 * minus_per_s_3;
            after->covariance[6] = v_40 + (v_41 * n_1_3);
            after->covariance[7] = v_38 + (v_39 * n_1_3);
            after->covariance[8] = v_49 + (v_50 * n_1_3);
            after->covariance[9] = v_58 + (v_59 * n_1_3);
            after->covariance[10] = v_67 + (v_68 * n_1_3);
            const float n_2_3 = v_39 * minus_per_s_3;
            after->covariance[11] = v_37 + (v_39 * n_2_3);
            after->covariance[12] = v_48 + (v_50 * n_2_3);
            after->covariance[13] = v_57 + (v_59 * n_2_3);
            after->covariance[14] = v_66 + (v_68 * n_2_3);
            const float n_3 = v_42 * minus_per_s;
            const float n_3_2 = v_46 * minus_per_s_2;
            const float n_3_3 = v_50 * minus_per_s_3;
            after->covariance[15] = ((before->covariance[15] + (v_42 * n_3)) + (v_46 * n_3_2)) + (v_50 * n_3_3);
            after->covariance[16] = ((before->covariance[16] + (v_51 * n_3)) + (v_55 * n_3_2)) + (v_59 * n_3_3);
            after->covariance[17] = ((before->covariance[17] + (v_60 * n_3)) + (v_64 * n_3_2)) + (v_68 * n_3_3);
            const float n_4 = v_51 * minus_per_s;
            const float n_4_2 = v_55 * minus_per_s_2;
            const float n_4_3 = v_59 * minus_per_s_3;
            after->covariance[18] = ((before->covariance[18] + (v_51 * n_4)) + (v_55 * n_4_2)) + (v_59 * n_4_3);
            after->covariance[19] = ((before->covariance[19] + (v_60 * n_4)) + (v_64 * n_4_2)) + (v_68 * n_4_3);
            const float n_5 = v_60 * minus_per_s;
            const float n_5_2 = v_64 * minus_per_s_2;
            const float n_5_3 = v_68 * minus_per_s_3;
            after->covariance[20] = ((before->covariance[20] + (v_60 * n_5)) + (v_64 * n_5_2)) + (v_68 * n_5_3);
            const float minus_e = -residual_0;
            const float v_69 = n_0 * minus_e;
            const float v_70 = n_2 * minus_e;
            const float v_71 = n_1 * minus_e;
            const float e = residual_1 - ((h_1_2 * v_70) + ((h_1_0 * v_69) + (h_1_1 * v_71)));
            const float minus_e_2 = -e;
            const float v_72 = v_69 + (n_0_2 * minus_e_2);
            const float v_73 = v_70 + (n_2_2 * minus_e_2);
            const float v_74 = v_71 + (n_1_2 * minus_e_2);
            const float e_2 = residual_2 - ((h_2_2 * v_73) + ((h_2_0 * v_72) + (h_2_1 * v_74)));
            const float minus_e_3 = -e_2;
            delta[0] = v_72 + (n_0_3 * minus_e_3);
            delta[1] = v_74 + (n_1_3 * minus_e_3);
            delta[2] = v_73 + (n_2_3 * minus_e_3);
            delta[3] = ((n_3 * minus_e) + (n_3_2 * minus_e_2)) + (n_3_3 * minus_e_3);
            delta[4] = ((n_4 * minus_e) + (n_4_2 * minus_e_2)) + (n_4_3 * minus_e_3);
            delta[5] = ((n_5 * minus_e) + (n_5_2 * minus_e_2)) + (n_5_3 * minus_e_3);
            nis[0] = ((residual_0 * (residual_0 * per_s)) + (e * (per_s_2 * e))) + (e_2 * (per_s_3 * e_2));
            row_variance[0] = s;
            row_variance[1] = s_2;
            row_variance[2] = s_3;
        }

        if (!(((row_variance[0] >= 1.0e-20f) == true) && ((row_variance[1] >= 1.0e-20f) == true)
              && ((row_variance[2] >= 1.0e-20f) == true)))
        {
            status = ATTITUDE_EKF_NOT_POSITIVE;
        }
        else
        {
            if (!(((nis[0] >= 0.0f) == true) && ((nis[0] <= 1.0e30f) == true)))
            {
                status = ATTITUDE_EKF_OVERFLOW;
            }
            else
            {
                out->nis = nis[0];

                /* accepted? */
                if ((gate <= 0.0f) || (nis[0] <= gate))
                {
                    /* x = x + d, attitudes turned by exp(d); the error is now counted from there: P = G P G' */
                    const float delta_0 = delta[0];
                    const float delta_1 = delta[1];
                    const float delta_2 = delta[2];
                    const float v_21 = sqrtf(1.0e-20f + (((delta_0 * delta_0) + (delta_1 * delta_1)) + (delta_2 *
                        delta_2)));
                    const float v_22 = 0.5f * v_21;
                    const float v_23 = attitude_ekf_math_cos(v_22);
                    const float v_24 = attitude_ekf_math_sin(v_22) / v_21;
                    const float v_25 = delta_0 * v_24;
                    const float v_26 = delta_1 * v_24;
                    const float v_27 = delta_2 * v_24;
                    const float v_28 = (((q_0 * v_23) - (q_1 * v_25)) - (q_2 * v_26)) - (q_3 * v_27);
                    const float v_29 = (((q_0 * v_25) + (q_1 * v_23)) + (q_2 * v_27)) - (q_3 * v_26);
                    const float v_30 = (((q_0 * v_26) - (q_1 * v_27)) + (q_2 * v_23)) + (q_3 * v_25);
                    const float v_31 = (((q_0 * v_27) + (q_1 * v_26)) - (q_2 * v_25)) + (q_3 * v_23);
                    const float v_32 = 1.5f - (0.5f * ((((v_28 * v_28) + (v_29 * v_29)) + (v_30 * v_30)) + (v_31 *
                        v_31)));
                    after->q[0] = v_28 * v_32;
                    after->q[1] = v_29 * v_32;
                    after->q[2] = v_30 * v_32;
                    after->q[3] = v_31 * v_32;
                    after->bias[0] = before->bias[0] + delta[3];
                    after->bias[1] = before->bias[1] + delta[4];
                    after->bias[2] = before->bias[2] + delta[5];
                    const float g_0_1 = 0.5f * delta_2;
                    const float g_2_0 = 0.5f * delta_1;
                    const float g_0_2 = -g_2_0;
                    const float g_1_0 = -g_0_1;
                    const float g_1_2 = 0.5f * delta_0;
                    const float g_2_1 = -g_1_2;

                    /* P = G P G', G = I - [d]x / 2 for an attitude */
                    {
                        const float p_2_2 = after->covariance[11];
                        const float p_0_2 = after->covariance[2];
                        const float p_1_2 = after->covariance[7];
                        const float v_33 = (g_0_2 * p_2_2) + (p_0_2 + (g_0_1 * p_1_2));
                        const float p_0_0 = after->covariance[0];
                        const float p_0_1 = after->covariance[1];
                        const float v_34 = (g_0_2 * p_0_2) + (p_0_0 + (g_0_1 * p_0_1));
                        const float p_1_1 = after->covariance[6];
                        const float v_35 = (g_0_2 * p_1_2) + (p_0_1 + (g_0_1 * p_1_1));
                        after->covariance[0] = (g_0_2 * v_33) + (v_34 + (g_0_1 * v_35));
                        after->covariance[1] = (g_1_2 * v_33) + (v_35 + (g_1_0 * v_34));
                        after->covariance[2] = (g_2_1 * v_35) + (v_33 + (g_2_0 * v_34));
                        const float p_2_3 = after->covariance[12];
                        const float p_0_3 = after->covariance[3];
                        const float p_1_3 = after->covariance[8];
                        after->covariance[3] = (g_0_2 * p_2_3) + (p_0_3 + (g_0_1 * p_1_3));
                        const float p_2_4 = after->covariance[13];
                        const float p_0_4 = after->covariance[4];
                        const float p_1_4 = after->covariance[9];
                        after->covariance[4] = (g_0_2 * p_2_4) + (p_0_4 + (g_0_1 * p_1_4));
                        const float p_2_5 = after->covariance[14];
                        const float p_0_5 = after->covariance[5];
                        const float p_1_5 = after->covariance[10];
                        after->covariance[5] = (g_0_2 * p_2_5) + (p_0_5 + (g_0_1 * p_1_5));
                        const float v_36 = (g_1_2 * p_2_2) + (p_1_2 + (g_1_0 * p_0_2));
                        const float v_37 = (g_1_2 * p_1_2) + (p_1_1 + (g_1_0 * p_0_1));
                        const float v_38 = (g_1_2 * p_0_2) + (p_0_1 + (g_1_0 * p_0_0));
                        after->covariance[6] = (g_1_2 * v_36) + (v_37 + (g_1_0 * v_38));
                        after->covariance[7] = (g_2_1 * v_37) + (v_36 + (g_2_0 * v_38));
                        after->covariance[8] = (g_1_2 * p_2_3) + (p_1_3 + (g_1_0 * p_0_3));
                        after->covariance[9] = (g_1_2 * p_2_4) + (p_1_4 + (g_1_0 * p_0_4));
                        after->covariance[10] = (g_1_2 * p_2_5) + (p_1_5 + (g_1_0 * p_0_5));
                        const float v_39 = ((g_2_1 * p_1_2) + (p_2_2 + (g_2_0 * p_0_2))) + (g_2_0 * ((g_2_1 * p_0_1) +
                            (p_0_2 + (g_2_0 * p_0_0))));
                        after->covariance[11] = (g_2_1 * ((g_2_1 * p_1_1) + (p_1_2 + (g_2_0 * p_0_1)))) + v_39;
                        after->covariance[12] = (g_2_1 * p_1_3) + (p_2_3 + (g_2_0 * p_0_3));
                        after->covariance[13] = (g_2_1 * p_1_4) + (p_2_4 + (g_2_0 * p_0_4));
                        after->covariance[14] = (g_2_1 * p_1_5) + (p_2_5 + (g_2_0 * p_0_5));
                    }
                    after->rejected_accelerometer = 0U;

                    /* judge, then commit */
                    if (!attitude_ekf_is_bounded(after->covariance))
                    {
                        status = attitude_ekf_hold_variances(after->covariance);
                    }
                    if (status >= ATTITUDE_EKF_OK)
                    {
                        if (!(((after->q[0] >= -1.01f) == true) && ((after->q[0] <= 1.01f) == true)
                              && ((after->q[1] >= -1.01f) == true) && ((after->q[1] <= 1.01f) == true)
                              && ((after->q[2] >= -1.01f) == true) && ((after->q[2] <= 1.01f) == true)
                              && ((after->q[3] >= -1.01f) == true) && ((after->q[3] <= 1.01f) == true)
                              && ((after->bias[0] >= -1.0f) == true) && ((after->bias[0] <= 1.0f) == true)
                              && ((after->bias[1] >= -1.0f) == true) && ((after->bias[1] <= 1.0f) == true)
                              && ((after->bias[2] >= -1.0f) == true) && ((after->bias[2] <= 1.0f) == true)))
                        {
                            status = ATTITUDE_EKF_OVERFLOW;
                        }
                    }
                }
                else
                {
                    *after = *before;
                    if (after->rejected_accelerometer < UINT32_MAX)
                    {
                        after->rejected_accelerometer = after->rejected_accelerometer + 1U;
                    }
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_GATED);
                }
            }
        }
    }
    return status;
}

/* 274 additions, 380 multiplications, 4 divisions, 12 negations, 3 selections, cosf, sinf, sqrtf. */
static attitude_ekf_status_t attitude_ekf_update_magnetometer_core(const attitude_ekf_state_t *before,
                                                                   attitude_ekf_state_t *after,
                                                                   const attitude_ekf_params_t *params,
                                                                   const float magnetometer[3], const float gate,
                                                                   attitude_ekf_update_magnetometer_out_t *out)
{
    float delta[6];
    float nis[1];
    float row_variance[3];
    attitude_ekf_status_t status = ATTITUDE_EKF_OK;

    after->rejected_accelerometer = before->rejected_accelerometer;

    if (!(((magnetometer[0] >= -2.0f) == true) && ((magnetometer[0] <= 2.0f) == true)
          && ((magnetometer[1] >= -2.0f) == true) && ((magnetometer[1] <= 2.0f) == true)
          && ((magnetometer[2] >= -2.0f) == true) && ((magnetometer[2] <= 2.0f) == true)))
    {
        status = ATTITUDE_EKF_BAD_INPUT;
    }
    else
    {
        /* residual[0] = magnetometer[0] - ((1 - 2 (q[2]^2 + q[3]^2)) field_north + 2 (q[1] q[3] - q[0] q[2])
         * field_down) */
        /* residual[1] = magnetometer[1] - (2 (q[1] q[2] - q[0] q[3]) field_north + 2 (q[2] q[3] + q[0] q[1])
         * field_down) */
        /* residual[2] = magnetometer[2] - (2 (q[1] q[3] + q[0] q[2]) field_north + (1 - 2 (q[1]^2 + q[2]^2))
         * field_down) */
        const float field_north = params->field_north;
        const float q_2 = before->q[2];
        const float v = q_2 * q_2;
        const float q_3 = before->q[3];
        const float field_down = params->field_down;
        const float q_1 = before->q[1];
        const float v_2 = q_1 * q_3;
        const float q_0 = before->q[0];
        const float v_3 = q_0 * q_2;
        const float v_4 = (field_north * (1.0f - ((v + (q_3 * q_3)) * 2.0f))) + (field_down * (2.0f * (v_2 - v_3)));
        const float residual_0 = magnetometer[0] - v_4;
        const float v_5 = (field_north * (2.0f * ((q_1 * q_2) - (q_0 * q_3)))) + (field_down * (2.0f * ((q_2 * q_3) +
            (q_0 * q_1))));
        const float residual_1 = magnetometer[1] - v_5;
        const float v_6 = (field_north * (2.0f * (v_2 + v_3))) + (field_down * (1.0f - (2.0f * (v + (q_1 * q_1)))));
        const float residual_2 = magnetometer[2] - v_6;
        const float v_7 = q_3 * 2.0f;
        const float v_8 = field_down * v_7;
        const float v_9 = q_0 * 0.5f;
        const float v_10 = field_down * (2.0f * (-q_2));
        const float v_11 = q_1 * 0.5f;
        const float v_12 = 2.0f * (-q_0);
        const float v_13 = q_2 * 4.0f;
        const float v_14 = (field_down * v_12) - (field_north * v_13);
        const float v_15 = q_3 * 0.5f;
        const float v_16 = q_1 * 2.0f;
        const float v_17 = field_down * v_16;
        const float v_18 = v_17 - (field_north * (q_3 * 4.0f));
        const float v_19 = q_2 * 0.5f;
        const float h_0_0 = (((v_8 * v_9) - (v_10 * v_11)) + (v_14 * v_15)) - (v_18 * v_19);
        const float h_0_1 = ((v_9 * v_14) - ((v_10 * v_19) + (v_8 * v_15))) + (v_11 * v_18);
        const float h_0_2 = (((v_8 * v_19) - (v_10 * v_15)) - (v_11 * v_14)) + (v_9 * v_18);
        const float v_20 = q_2 * 2.0f;
        const float v_21 = field_north * v_20;
        const float v_22 = q_0 * 2.0f;
        const float v_23 = v_21 + (field_down * v_22);
        const float v_24 = v_17 + (field_north * (2.0f * (-q_3)));
        const float v_25 = field_north * v_16;
        const float v_26 = v_8 + v_25;
        const float v_27 = (field_north * v_12) + (field_down * v_20);
        const float h_1_0 = (((v_9 * v_23) - (v_11 * v_24)) + (v_15 * v_26)) - (v_19 * v_27);
        const float h_1_1 = ((v_9 * v_26) - ((v_19 * v_24) + (v_15 * v_23))) + (v_11 * v_27);
        const float h_1_2 = (((v_19 * v_23) - (v_15 * v_24)) - (v_11 * v_26)) + (v_9 * v_27);
        const float v_28 = (field_north * v_7) - (field_down * (q_1 * 4.0f));
        const float v_29 = (field_north * v_22) - (field_down * v_13);
        const float h_2_0 = (((v_9 * v_28) - (v_11 * v_21)) + (v_15 * v_29)) - (v_19 * v_25);
        const float h_2_1 = ((v_9 * v_29) - ((v_19 * v_21) + (v_15 * v_28))) + (v_11 * v_25);
        const float h_2_2 = (((v_19 * v_28) - (v_15 * v_21)) - (v_11 * v_29)) + (v_9 * v_25);

        /* variance of the innovation: diagonal of H P H' + R */
        {
            const float p_2_2 = before->covariance[11];
            const float p_0_2 = before->covariance[2];
            const float p_1_2 = before->covariance[7];
            const float p_0_0 = before->covariance[0];
            const float p_0_1 = before->covariance[1];
            const float p_1_1 = before->covariance[6];
            const float v_30 = (h_0_0 * ((h_0_2 * p_0_2) + ((h_0_0 * p_0_0) + (h_0_1 * p_0_1)))) + (h_0_1 * ((h_0_2 *
                p_1_2) + ((h_0_0 * p_0_1) + (h_0_1 * p_1_1))));
            out->variance[0] = params->variance_magnetometer[0] + ((h_0_2 * ((h_0_2 * p_2_2) + ((h_0_0 * p_0_2) + (h_0_1
                * p_1_2)))) + v_30);
            const float v_31 = (h_1_0 * ((h_1_2 * p_0_2) + ((h_1_0 * p_0_0) + (h_1_1 * p_0_1)))) + (h_1_1 * ((h_1_2 *
                p_1_2) + ((h_1_0 * p_0_1) + (h_1_1 * p_1_1))));
            out->variance[1] = params->variance_magnetometer[1] + ((h_1_2 * ((h_1_2 * p_2_2) + ((h_1_0 * p_0_2) + (h_1_1
                * p_1_2)))) + v_31);
            const float v_32 = (h_2_0 * ((h_2_2 * p_0_2) + ((h_2_0 * p_0_0) + (h_2_1 * p_0_1)))) + (h_2_1 * ((h_2_2 *
                p_1_2) + ((h_2_0 * p_0_1) + (h_2_1 * p_1_1))));
            out->variance[2] = params->variance_magnetometer[2] + ((h_2_2 * ((h_2_2 * p_2_2) + ((h_2_0 * p_0_2) + (h_2_1
                * p_1_2)))) + v_32);
        }
        out->innovation[0] = residual_0;
        out->innovation[1] = residual_1;
        out->innovation[2] = residual_2;

        /* row 0: d = d + K e, P = P - K s K' */
        /* row 1: d = d + K e, P = P - K s K' */
        /* row 2: d = d + K e, P = P - K s K' */
        {
            const float p_0_0 = before->covariance[0];
            const float p_0_2 = before->covariance[2];
            const float p_0_1 = before->covariance[1];
            const float v_30 = (h_0_2 * p_0_2) + ((h_0_0 * p_0_0) + (h_0_1 * p_0_1));
            const float p_2_2 = before->covariance[11];
            const float p_1_2 = before->covariance[7];
            const float v_31 = (h_0_2 * p_2_2) + ((h_0_0 * p_0_2) + (h_0_1 * p_1_2));
            const float p_1_1 = before->covariance[6];
            const float v_32 = (h_0_2 * p_1_2) + ((h_0_0 * p_0_1) + (h_0_1 * p_1_1));
            const float s = params->variance_magnetometer[0] + ((h_0_2 * v_31) + ((h_0_0 * v_30) + (h_0_1 * v_32)));
            const float per_s = 1.0f / ((s >= 1.0e-20f) ? s : 1.0f);
            const float minus_per_s = -per_s;
            const float n_0 = v_30 * minus_per_s;
            const float v_33 = p_0_0 + (v_30 * n_0);
            const float v_34 = p_0_2 + (v_31 * n_0);
            const float v_35 = p_0_1 + (v_32 * n_0);
            const float v_36 = (h_1_2 * v_34) + ((h_1_0 * v_33) + (h_1_1 * v_35));
            const float n_2 = v_31 * minus_per_s;
            const float v_37 = p_2_2 + (v_31 * n_2);
            const float n_1 = v_32 * minus_per_s;
            const float v_38 = p_1_2 + (v_31 * n_1);
            const float v_39 = (h_1_2 * v_37) + ((h_1_0 * v_34) + (h_1_1 * v_38));
            const float v_40 = p_1_1 + (v_32 * n_1);
            const float v_41 = (h_1_2 * v_38) + ((h_1_0 * v_35) + (h_1_1 * v_40));
            const float s_2 = params->variance_magnetometer[1] + ((h_1_2 * v_39) + ((h_1_0 * v_36) + (h_1_1 * v_41)));
            const float per_s_2 = 1.0f / ((s_2 >= 1.0e-20f) ? s_2 : 1.0f);
            const float minus_per_s_2 = -per_s_2;
            const float n_0_2 = v_36 * minus_per_s_2;
            const float v_42 = v_33 + (v_36 * n_0_2);
            const float v_43 = v_34 + (v_39 * n_0_2);
            const float v_44 = v_35 + (v_41 * n_0_2);
            const float v_45 = (h_2_2 * v_43) + ((h_2_0 * v_42) + (h_2_1 * v_44));
            const float n_2_2 = v_39 * minus_per_s_2;
            const float v_46 = v_37 + (v_39 * n_2_2);
            const float n_1_2 = v_41 * minus_per_s_2;
            const float v_47 = v_38 + (v_39 * n_1_2);
            const float v_48 = (h_2_2 * v_46) + ((h_2_0 * v_43) + (h_2_1 * v_47));
            const float v_49 = v_40 + (v_41 * n_1_2);
            const float v_50 = (h_2_2 * v_47) + ((h_2_0 * v_44) + (h_2_1 * v_49));
            const float s_3 = params->variance_magnetometer[2] + ((h_2_2 * v_48) + ((h_2_0 * v_45) + (h_2_1 * v_50)));
            const float per_s_3 = 1.0f / ((s_3 >= 1.0e-20f) ? s_3 : 1.0f);
            const float minus_per_s_3 = -per_s_3;
            const float n_0_3 = v_45 * minus_per_s_3;
            after->covariance[0] = v_42 + (v_45 * n_0_3);
            after->covariance[1] = v_44 + (v_50 * n_0_3);
            after->covariance[2] = v_43 + (v_48 * n_0_3);
            const float p_0_3 = before->covariance[3];
            const float p_2_3 = before->covariance[12];
            const float p_1_3 = before->covariance[8];
            const float v_51 = (h_0_2 * p_2_3) + ((h_0_0 * p_0_3) + (h_0_1 * p_1_3));
            const float v_52 = p_0_3 + (v_51 * n_0);
            const float v_53 = p_2_3 + (v_51 * n_2);
            const float v_54 = p_1_3 + (v_51 * n_1);
            const float v_55 = (h_1_2 * v_53) + ((h_1_0 * v_52) + (h_1_1 * v_54));
            const float v_56 = v_52 + (v_55 * n_0_2);
            const float v_57 = v_53 + (v_55 * n_2_2);
            const float v_58 = v_54 + (v_55 * n_1_2);
            const float v_59 = (h_2_2 * v_57) + ((h_2_0 * v_56) + (h_2_1 * v_58));
            after->covariance[3] = v_56 + (v_59 * n_0_3);
            const float p_0_4 = before->covariance[4];
            const float p_2_4 = before->covariance[13];
            const float p_1_4 = before->covariance[9];
            const float v_60 = (h_0_2 * p_2_4) + ((h_0_0 * p_0_4) + (h_0_1 * p_1_4));
            const float v_61 = p_0_4 + (v_60 * n_0);
            const float v_62 = p_2_4 + (v_60 * n_2);
            const float v_63 = p_1_4 + (v_60 * n_1);
            const float v_64 = (h_1_2 * v_62) + ((h_1_0 * v_61) + (h_1_1 * v_63));
            const float v_65 = v_61 + (v_64 * n_0_2);
            const float v_66 = v_62 + (v_64 * n_2_2);
            const float v_67 = v_63 + (v_64 * n_1_2);
            const float v_68 = (h_2_2 * v_66) + ((h_2_0 * v_65) + (h_2_1 * v_67));
            after->covariance[4] = v_65 + (v_68 * n_0_3);
            const float p_0_5 = before->covariance[5];
            const float p_2_5 = before->covariance[14];
            const float p_1_5 = before->covariance[10];
            const float v_69 = (h_0_2 * p_2_5) + ((h_0_0 * p_0_5) + (h_0_1 * p_1_5));
            const float v_70 = p_0_5 + (v_69 * n_0);
            const float v_71 = p_2_5 + (v_69 * n_2);
            const float v_72 = p_1_5 + (v_69 * n_1);
            const float v_73 = (h_1_2 * v_71) + ((h_1_0 * v_70) + (h_1_1 * v_72));
            const float v_74 = v_70 + (v_73 * n_0_2);
            const float v_75 = v_71 + (v_73 * n_2_2);
            const float v_76 = v_72 + (v_73 * n_1_2);
            const float v_77 = (h_2_2 * v_75) + ((h_2_0 * v_74) + (h_2_1 * v_76));
            after->covariance[5] = v_74 + (v_77 * n_0_3);
            const float n_1_3 = v_50 * minus_per_s_3;
            after->covariance[6] = v_49 + (v_50 * n_1_3);
            after->covariance[7] = v_47 + (v_48 * n_1_3);
            after->covariance[8] = v_58 + (v_59 * n_1_3);
            after->covariance[9] = v_67 + (v_68 * n_1_3);
            after->covariance[10] = v_76 + (v_77 * n_1_3);
            const float n_2_3 = v_48 * minus_per_s_3;
            after->covariance[11] = v_46 + (v_48 * n_2_3);
            after->covariance[12] = v_57 + (v_59 * n_2_3);
            after->covariance[13] = v_66 + (v_68 * n_2_3);
            after->covariance[14] = v_75 + (v_77 * n_2_3);
            const float n_3 = v_51 * minus_per_s;
            const float n_3_2 = v_55 * minus_per_s_2;
            const float n_3_3 = v_59 * minus_per_s_3;
            after->covariance[15] = ((before->covariance[15] + (v_51 * n_3)) + (v_55 * n_3_2)) + (v_59 * n_3_3);
            after->covariance[16] = ((before->covariance[16] + (v_60 * n_3)) + (v_64 * n_3_2)) + (v_68 * n_3_3);
            after->covariance[17] = ((before->covariance[17] + (v_69 * n_3)) + (v_73 * n_3_2)) + (v_77 * n_3_3);
            const float n_4 = v_60 * minus_per_s;
            const float n_4_2 = v_64 * minus_per_s_2;
            const float n_4_3 = v_68 * minus_per_s_3;
            after->covariance[18] = ((before->covariance[18] + (v_60 * n_4)) + (v_64 * n_4_2)) + (v_68 * n_4_3);
            after->covariance[19] = ((before->covariance[19] + (v_69 * n_4)) + (v_73 * n_4_2)) + (v_77 * n_4_3);
            const float n_5 = v_69 * minus_per_s;
            const float n_5_2 = v_73 * minus_per_s_2;
            const float n_5_3 = v_77 * minus_per_s_3;
            after->covariance[20] = ((before->covariance[20] + (v_69 * n_5)) + (v_73 * n_5_2)) + (v_77 * n_5_3);
            const float minus_e = -residual_0;
            const float v_78 = n_0 * minus_e;
            const float v_79 = n_2 * minus_e;
            const float v_80 = n_1 * minus_e;
            const float e = residual_1 - ((h_1_2 * v_79) + ((h_1_0 * v_78) + (h_1_1 * v_80)));
            const float minus_e_2 = -e;
            const float v_81 = v_78 + (n_0_2 * minus_e_2);
            const float v_82 = v_79 + (n_2_2 * minus_e_2);
            const float v_83 = v_80 + (n_1_2 * minus_e_2);
            const float e_2 = residual_2 - ((h_2_2 * v_82) + ((h_2_0 * v_81) + (h_2_1 * v_83)));
            const float minus_e_3 = -e_2;
            delta[0] = v_81 + (n_0_3 * minus_e_3);
            delta[1] = v_83 + (n_1_3 * minus_e_3);
            delta[2] = v_82 + (n_2_3 * minus_e_3);
            delta[3] = ((n_3 * minus_e) + (n_3_2 * minus_e_2)) + (n_3_3 * minus_e_3);
            delta[4] = ((n_4 * minus_e) + (n_4_2 * minus_e_2)) + (n_4_3 * minus_e_3);
            delta[5] = ((n_5 * minus_e) + (n_5_2 * minus_e_2)) + (n_5_3 * minus_e_3);
            nis[0] = ((residual_0 * (residual_0 * per_s)) + (e * (per_s_2 * e))) + (e_2 * (per_s_3 * e_2));
            row_variance[0] = s;
            row_variance[1] = s_2;
            row_variance[2] = s_3;
        }

        if (!(((row_variance[0] >= 1.0e-20f) == true) && ((row_variance[1] >= 1.0e-20f) == true)
              && ((row_variance[2] >= 1.0e-20f) == true)))
        {
            status = ATTITUDE_EKF_NOT_POSITIVE;
        }
        else
        {
            if (!(((nis[0] >= 0.0f) == true) && ((nis[0] <= 1.0e30f) == true)))
            {
                status = ATTITUDE_EKF_OVERFLOW;
            }
            else
            {
                out->nis = nis[0];

                /* accepted? */
                if ((gate <= 0.0f) || (nis[0] <= gate))
                {
                    /* x = x + d, attitudes turned by exp(d); the error is now counted from there: P = G P G' */
                    const float delta_0 = delta[0];
                    const float delta_1 = delta[1];
                    const float delta_2 = delta[2];
                    const float v_30 = sqrtf(1.0e-20f + (((delta_0 * delta_0) + (delta_1 * delta_1)) + (delta_2 *
                        delta_2)));
                    const float v_31 = 0.5f * v_30;
                    const float v_32 = attitude_ekf_math_cos(v_31);
                    const float v_33 = attitude_ekf_math_sin(v_31) / v_30;
                    const float v_34 = delta_0 * v_33;
                    const float v_35 = delta_1 * v_33;
                    const float v_36 = delta_2 * v_33;
                    const float v_37 = (((q_0 * v_32) - (q_1 * v_34)) - (q_2 * v_35)) - (q_3 * v_36);
                    const float v_38 = (((q_0 * v_34) + (q_1 * v_32)) + (q_2 * v_36)) - (q_3 * v_35);
                    const float v_39 = (((q_0 * v_35) - (q_1 * v_36)) + (q_2 * v_32)) + (q_3 * v_34);
                    const float v_40 = (((q_0 * v_36) + (q_1 * v_35)) - (q_2 * v_34)) + (q_3 * v_32);
                    const float v_41 = 1.5f - (0.5f * ((((v_37 * v_37) + (v_38 * v_38)) + (v_39 * v_39)) + (v_40 *
                        v_40)));
                    after->q[0] = v_37 * v_41;
                    after->q[1] = v_38 * v_41;
                    after->q[2] = v_39 * v_41;
                    after->q[3] = v_40 * v_41;
                    after->bias[0] = before->bias[0] + delta[3];
                    after->bias[1] = before->bias[1] + delta[4];
                    after->bias[2] = before->bias[2] + delta[5];
                    const float g_0_1 = 0.5f * delta_2;
                    const float g_2_0 = 0.5f * delta_1;
                    const float g_0_2 = -g_2_0;
                    const float g_1_0 = -g_0_1;
                    const float g_1_2 = 0.5f * delta_0;
                    const float g_2_1 = -g_1_2;

                    /* P = G P G', G = I - [d]x / 2 for an attitude */
                    {
                        const float p_2_2 = after->covariance[11];
                        const float p_0_2 = after->covariance[2];
                        const float p_1_2 = after->covariance[7];
                        const float v_42 = (g_0_2 * p_2_2) + (p_0_2 + (g_0_1 * p_1_2));
                        const float p_0_0 = after->covariance[0];
                        const float p_0_1 = after->covariance[1];
                        const float v_43 = (g_0_2 * p_0_2) + (p_0_0 + (g_0_1 * p_0_1));
                        const float p_1_1 = after->covariance[6];
                        const float v_44 = (g_0_2 * p_1_2) + (p_0_1 + (g_0_1 * p_1_1));
                        after->covariance[0] = (g_0_2 * v_42) + (v_43 + (g_0_1 * v_44));
                        after->covariance[1] = (g_1_2 * v_42) + (v_44 + (g_1_0 * v_43));
                        after->covariance[2] = (g_2_1 * v_44) + (v_42 + (g_2_0 * v_43));
                        const float p_2_3 = after->covariance[12];
                        const float p_0_3 = after->covariance[3];
                        const float p_1_3 = after->covariance[8];
                        after->covariance[3] = (g_0_2 * p_2_3) + (p_0_3 + (g_0_1 * p_1_3));
                        const float p_2_4 = after->covariance[13];
                        const float p_0_4 = after->covariance[4];
                        const float p_1_4 = after->covariance[9];
                        after->covariance[4] = (g_0_2 * p_2_4) + (p_0_4 + (g_0_1 * p_1_4));
                        const float p_2_5 = after->covariance[14];
                        const float p_0_5 = after->covariance[5];
                        const float p_1_5 = after->covariance[10];
                        after->covariance[5] = (g_0_2 * p_2_5) + (p_0_5 + (g_0_1 * p_1_5));
                        const float v_45 = (g_1_2 * p_2_2) + (p_1_2 + (g_1_0 * p_0_2));
                        const float v_46 = (g_1_2 * p_1_2) + (p_1_1 + (g_1_0 * p_0_1));
                        const float v_47 = (g_1_2 * p_0_2) + (p_0_1 + (g_1_0 * p_0_0));
                        after->covariance[6] = (g_1_2 * v_45) + (v_46 + (g_1_0 * v_47));
                        after->covariance[7] = (g_2_1 * v_46) + (v_45 + (g_2_0 * v_47));
                        after->covariance[8] = (g_1_2 * p_2_3) + (p_1_3 + (g_1_0 * p_0_3));
                        after->covariance[9] = (g_1_2 * p_2_4) + (p_1_4 + (g_1_0 * p_0_4));
                        after->covariance[10] = (g_1_2 * p_2_5) + (p_1_5 + (g_1_0 * p_0_5));
                        const float v_48 = ((g_2_1 * p_1_2) + (p_2_2 + (g_2_0 * p_0_2))) + (g_2_0 * ((g_2_1 * p_0_1) +
                            (p_0_2 + (g_2_0 * p_0_0))));
                        after->covariance[11] = (g_2_1 * ((g_2_1 * p_1_1) + (p_1_2 + (g_2_0 * p_0_1)))) + v_48;
                        after->covariance[12] = (g_2_1 * p_1_3) + (p_2_3 + (g_2_0 * p_0_3));
                        after->covariance[13] = (g_2_1 * p_1_4) + (p_2_4 + (g_2_0 * p_0_4));
                        after->covariance[14] = (g_2_1 * p_1_5) + (p_2_5 + (g_2_0 * p_0_5));
                    }
                    after->rejected_magnetometer = 0U;

                    /* judge, then commit */
                    if (!attitude_ekf_is_bounded(after->covariance))
                    {
                        status = attitude_ekf_hold_variances(after->covariance);
                    }
                    if (status >= ATTITUDE_EKF_OK)
                    {
                        if (!(((after->q[0] >= -1.01f) == true) && ((after->q[0] <= 1.01f) == true)
                              && ((after->q[1] >= -1.01f) == true) && ((after->q[1] <= 1.01f) == true)
                              && ((after->q[2] >= -1.01f) == true) && ((after->q[2] <= 1.01f) == true)
                              && ((after->q[3] >= -1.01f) == true) && ((after->q[3] <= 1.01f) == true)
                              && ((after->bias[0] >= -1.0f) == true) && ((after->bias[0] <= 1.0f) == true)
                              && ((after->bias[1] >= -1.0f) == true) && ((after->bias[1] <= 1.0f) == true)
                              && ((after->bias[2] >= -1.0f) == true) && ((after->bias[2] <= 1.0f) == true)))
                        {
                            status = ATTITUDE_EKF_OVERFLOW;
                        }
                    }
                }
                else
                {
                    *after = *before;
                    if (after->rejected_magnetometer < UINT32_MAX)
                    {
                        after->rejected_magnetometer = after->rejected_magnetometer + 1U;
                    }
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_GATED);
                }
            }
        }
    }
    return status;
}

/* 21 multiplications. */
static attitude_ekf_status_t attitude_ekf_inflate_core(const attitude_ekf_state_t *before, attitude_ekf_state_t *after,
                                                       const float factor)
{
    attitude_ekf_status_t status = ATTITUDE_EKF_OK;

    after->q[0] = before->q[0];
    after->q[1] = before->q[1];
    after->q[2] = before->q[2];
    after->q[3] = before->q[3];
    after->bias[0] = before->bias[0];
    after->bias[1] = before->bias[1];
    after->bias[2] = before->bias[2];
    after->rejected_accelerometer = before->rejected_accelerometer;
    after->rejected_magnetometer = before->rejected_magnetometer;

    if (!(((factor >= 1.0f) == true) && ((factor <= 1000000.0f) == true)))
    {
        status = ATTITUDE_EKF_BAD_INPUT;
    }
    else
    {
        /* P = factor P */
        for (uint32_t i = 0U; i < 21U; i++)
        {
            after->covariance[i] = factor * before->covariance[i];
        }

        /* judge, then commit */
        if (!attitude_ekf_is_bounded(after->covariance))
        {
            status = attitude_ekf_hold_variances(after->covariance);
        }
    }
    return status;
}

static attitude_ekf_status_t attitude_ekf_step_core(const attitude_ekf_state_t *before, attitude_ekf_state_t *after,
                                                    const attitude_ekf_params_t *params, const float gyro[3],
                                                    const float dt, const bool has_accelerometer,
                                                    const float accelerometer[3], const bool has_magnetometer,
                                                    const float magnetometer[3], attitude_ekf_step_out_t *out)
{
    attitude_ekf_state_t work[2];
    attitude_ekf_state_t *latest = &work[0];
    attitude_ekf_state_t *spare = after;
    attitude_ekf_status_t status = attitude_ekf_predict_core(before, latest, params, gyro, dt);

    if (status >= ATTITUDE_EKF_OK)
    {
        /* accelerometer */
        if (has_accelerometer)
        {
            /* accelerometer gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_accelerometer >= params->reject_limit))
            {
                attitude_ekf_status_t own = attitude_ekf_inflate_core(latest, &work[1], params->inflation);
                attitude_ekf_status_t highest = status;

                if (own >= ATTITUDE_EKF_OK)
                {
                    highest = attitude_ekf_higher(highest, own);
                    own = attitude_ekf_update_accelerometer_core(&work[1], spare, accelerometer, 0.0f,
                        &out->accelerometer);
                }
                out->status_accelerometer = own;
                if (own >= ATTITUDE_EKF_OK)
                {
                    attitude_ekf_state_t *const taken = spare;

                    spare = latest;
                    latest = taken;
                    status = attitude_ekf_higher(highest, own);
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_RECOVERED);
                }
                else
                {
                    out->accelerometer.innovation[0] = 0.0f;
                    out->accelerometer.innovation[1] = 0.0f;
                    out->accelerometer.innovation[2] = 0.0f;
                    out->accelerometer.variance[0] = 0.0f;
                    out->accelerometer.variance[1] = 0.0f;
                    out->accelerometer.variance[2] = 0.0f;
                    out->accelerometer.nis = 0.0f;
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_SKIPPED);
                }
            }
            else
            {
                attitude_ekf_status_t own = attitude_ekf_update_accelerometer_core(latest, spare, accelerometer,
                    params->gate_accelerometer, &out->accelerometer);

                out->status_accelerometer = own;
                if (own >= ATTITUDE_EKF_OK)
                {
                    attitude_ekf_state_t *const taken = spare;

                    spare = latest;
                    latest = taken;
                    status = attitude_ekf_higher(status, own);
                }
                else
                {
                    out->accelerometer.innovation[0] = 0.0f;
                    out->accelerometer.innovation[1] = 0.0f;
                    out->accelerometer.innovation[2] = 0.0f;
                    out->accelerometer.variance[0] = 0.0f;
                    out->accelerometer.variance[1] = 0.0f;
                    out->accelerometer.variance[2] = 0.0f;
                    out->accelerometer.nis = 0.0f;
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_SKIPPED);
                }
            }
        }
        else
        {
            out->accelerometer.innovation[0] = 0.0f;
            out->accelerometer.innovation[1] = 0.0f;
            out->accelerometer.innovation[2] = 0.0f;
            out->accelerometer.variance[0] = 0.0f;
            out->accelerometer.variance[1] = 0.0f;
            out->accelerometer.variance[2] = 0.0f;
            out->accelerometer.nis = 0.0f;
            out->status_accelerometer = ATTITUDE_EKF_OK;
        }
        /* magnetometer */
        if (has_magnetometer)
        {
            /* magnetometer gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_magnetometer >= params->reject_limit))
            {
                attitude_ekf_status_t own = attitude_ekf_inflate_core(latest, &work[1], params->inflation);
                attitude_ekf_status_t highest = status;

                if (own >= ATTITUDE_EKF_OK)
                {
                    highest = attitude_ekf_higher(highest, own);
                    own = attitude_ekf_update_magnetometer_core(&work[1], spare, params, magnetometer, 0.0f,
                        &out->magnetometer);
                }
                out->status_magnetometer = own;
                if (own >= ATTITUDE_EKF_OK)
                {
                    latest = spare;
                    status = attitude_ekf_higher(highest, own);
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_RECOVERED);
                }
                else
                {
                    out->magnetometer.innovation[0] = 0.0f;
                    out->magnetometer.innovation[1] = 0.0f;
                    out->magnetometer.innovation[2] = 0.0f;
                    out->magnetometer.variance[0] = 0.0f;
                    out->magnetometer.variance[1] = 0.0f;
                    out->magnetometer.variance[2] = 0.0f;
                    out->magnetometer.nis = 0.0f;
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_SKIPPED);
                }
            }
            else
            {
                attitude_ekf_status_t own = attitude_ekf_update_magnetometer_core(latest, spare, params, magnetometer,
                    params->gate_magnetometer, &out->magnetometer);

                out->status_magnetometer = own;
                if (own >= ATTITUDE_EKF_OK)
                {
                    latest = spare;
                    status = attitude_ekf_higher(status, own);
                }
                else
                {
                    out->magnetometer.innovation[0] = 0.0f;
                    out->magnetometer.innovation[1] = 0.0f;
                    out->magnetometer.innovation[2] = 0.0f;
                    out->magnetometer.variance[0] = 0.0f;
                    out->magnetometer.variance[1] = 0.0f;
                    out->magnetometer.variance[2] = 0.0f;
                    out->magnetometer.nis = 0.0f;
                    status = attitude_ekf_higher(status, ATTITUDE_EKF_SKIPPED);
                }
            }
        }
        else
        {
            out->magnetometer.innovation[0] = 0.0f;
            out->magnetometer.innovation[1] = 0.0f;
            out->magnetometer.innovation[2] = 0.0f;
            out->magnetometer.variance[0] = 0.0f;
            out->magnetometer.variance[1] = 0.0f;
            out->magnetometer.variance[2] = 0.0f;
            out->magnetometer.nis = 0.0f;
            out->status_magnetometer = ATTITUDE_EKF_OK;
        }
        if (latest != after)
        {
            *after = *latest;
        }
    }
    return status;
}

attitude_ekf_status_t attitude_ekf_init(attitude_ekf_state_t *state, const attitude_ekf_params_t *params)
{
    attitude_ekf_state_t after;
    const attitude_ekf_status_t status = attitude_ekf_init_core(&after, params);

    if (status >= ATTITUDE_EKF_OK)
    {
        *state = after;
    }
    return status;
}

attitude_ekf_status_t attitude_ekf_predict(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                           const attitude_ekf_predict_in_t *in)
{
    attitude_ekf_state_t after;
    const attitude_ekf_status_t status = attitude_ekf_predict_core(state, &after, params, in->gyro, in->dt);

    if (status >= ATTITUDE_EKF_OK)
    {
        *state = after;
    }
    return status;
}

attitude_ekf_status_t attitude_ekf_update_accelerometer(attitude_ekf_state_t *state,
                                                        const attitude_ekf_params_t *params,
                                                        const attitude_ekf_update_accelerometer_in_t *in,
                                                        attitude_ekf_update_accelerometer_out_t *out)
{
    attitude_ekf_state_t after;
    attitude_ekf_update_accelerometer_out_t answer;
    const attitude_ekf_status_t status = attitude_ekf_update_accelerometer_core(state, &after, in->accelerometer,
        params->gate_accelerometer, &answer);

    if (status >= ATTITUDE_EKF_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

attitude_ekf_status_t attitude_ekf_update_magnetometer(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                                       const attitude_ekf_update_magnetometer_in_t *in,
                                                       attitude_ekf_update_magnetometer_out_t *out)
{
    attitude_ekf_state_t after;
    attitude_ekf_update_magnetometer_out_t answer;
    const attitude_ekf_status_t status = attitude_ekf_update_magnetometer_core(state, &after, params, in->magnetometer,
        params->gate_magnetometer, &answer);

    if (status >= ATTITUDE_EKF_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

attitude_ekf_status_t attitude_ekf_step(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                        const attitude_ekf_step_in_t *in, attitude_ekf_step_out_t *out)
{
    attitude_ekf_step_out_t answer;
    const attitude_ekf_status_t status = attitude_ekf_step_core(state, state, params, in->gyro, in->dt,
        in->has_accelerometer, in->accelerometer, in->has_magnetometer, in->magnetometer, &answer);

    if (status >= ATTITUDE_EKF_OK)
    {
        *out = answer;
    }
    return status;
}

attitude_ekf_status_t attitude_ekf_inflate(attitude_ekf_state_t *state, const attitude_ekf_params_t *params,
                                           const attitude_ekf_inflate_in_t *in)
{
    attitude_ekf_state_t after;
    const attitude_ekf_status_t status = attitude_ekf_inflate_core(state, &after, in->factor);

    (void)params;

    if (status >= ATTITUDE_EKF_OK)
    {
        *state = after;
    }
    return status;
}

/* The hash of the model, as in the header. */
const char *attitude_ekf_model(void)
{
    return "dc394edc";
}

/* A sentence for a status. */
const char *attitude_ekf_status_text(attitude_ekf_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case ATTITUDE_EKF_OK:
            text = "ok";
            break;
        case ATTITUDE_EKF_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case ATTITUDE_EKF_CLAMPED:
            text = "a value (a variance, a command) was held at its limit";
            break;
        case ATTITUDE_EKF_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case ATTITUDE_EKF_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case ATTITUDE_EKF_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case ATTITUDE_EKF_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case ATTITUDE_EKF_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case ATTITUDE_EKF_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
