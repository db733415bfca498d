/* quadrotor_ud: see quadrotor_ud.h. Written by plantc 0.1.0 from model f4dfb1d1. */
#include "quadrotor_ud.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "quadrotor_ud checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static quadrotor_ud_status_t quadrotor_ud_higher(quadrotor_ud_status_t first, quadrotor_ud_status_t second)
{
    return (first > second) ? first : second;
}

/* Mathematics of plantc's own: no sin, exp ... of a C library is called. It takes + - * /, square roots, comparisons
    and
 * exact conversions only, and so gives the same bits on every machine where the FPU rounds to nearest, keeps denormals
 * and NaN (no flush to zero, no default NaN), and products are not fused with sums (-ffp-contract=off). */

/* (sin(x) - x) / x^3 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float quadrotor_ud_math_sin_series(float z)
{
    float sum = 2.7249926e-6f;

    sum = -0.00019840087f + (z * sum);
    sum = 0.008333332f + (z * sum);
    sum = -0.16666667f + (z * sum);
    return sum;
}

/* (cos(x) - 1 + x^2/2) / x^4 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float quadrotor_ud_math_cos_series(float z)
{
    float sum = 0.000024547942f;

    sum = -0.0013888302f + (z * sum);
    sum = 0.041666664f + (z * sum);
    return sum;
}

/* |x| = quadrant pi/2 + remainder[0] + remainder[1], for |x| <= 1073741824: |x| 2/pi in fixed point, of which 62 bits
 * are behind the point. The quadrant is modulo 4. */
static uint32_t quadrotor_ud_math_reduce(float magnitude, float remainder[2])
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
static float quadrotor_ud_math_turned(uint32_t quadrant, const float remainder[2])
{
    const float r = remainder[0];
    const float z = r * r;
    float value;

    if ((quadrant & 1U) == 0U)
    {
        const float rest = remainder[1] - (remainder[1] * (0.5f * z));

        value = r + (((r * z) * quadrotor_ud_math_sin_series(z)) + rest);
    }
    else
    {
        value = 1.0f - ((z * (0.5f - (z * quadrotor_ud_math_cos_series(z)))) + (r * remainder[1]));
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
static float quadrotor_ud_math_sin(float x)
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

            value = magnitude + ((magnitude * z) * quadrotor_ud_math_sin_series(z));
        }
        else if ((magnitude <= 1.0737418e9f) == true)
        {
            float remainder[2];
            const uint32_t quadrant = quadrotor_ud_math_reduce(magnitude, remainder);

            value = quadrotor_ud_math_turned(quadrant, remainder);
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
static float quadrotor_ud_math_cos(float x)
{
    const float magnitude = fabsf(x);
    float value;

    if (magnitude <= 0.7853982f)
    {
        const float z = magnitude * magnitude;

        value = 1.0f - (z * (0.5f - (z * quadrotor_ud_math_cos_series(z))));
    }
    else if ((magnitude <= 1.0737418e9f) == true)
    {
        float remainder[2];
        const uint32_t quadrant = quadrotor_ud_math_reduce(magnitude, remainder);

        value = quadrotor_ud_math_turned(quadrant + 1U, remainder);
    }
    else
    {
        value = NAN;
    }
    return value;
}

/* Whether every element is within its bounds; false for NaN. A comparison that decides what is stored is written
 * (... == true), from which Frama-C sees that NaN does not pass. */
static bool quadrotor_ud_is_held(const float factors[78])
{
    static const float limit[78] = {
        1.0e9f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        1.0e9f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 1.0e9f,
        3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 1.0e9f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        1.0e9f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 1.0e9f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 1.0e9f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 3.1622777e14f, 1.0e9f, 3.1622777e14f, 3.1622777e14f,
        3.1622777e14f, 3.1622777e14f, 1.0e9f, 3.1622777e14f, 3.1622777e14f, 3.1622777e14f,
        1.0e9f, 3.1622777e14f, 3.1622777e14f, 1.0e9f, 3.1622777e14f, 1.0e9f
    };
    bool held = true;

    for (uint32_t i = 0U; (i < 78U) && held; i++)
    {
        held = ((factors[i] >= -limit[i]) == true)
               && ((factors[i] <= limit[i]) == true);
    }
    return held
           && ((factors[0] >= 1.0e-20f) == true)
           && ((factors[12] >= 1.0e-20f) == true)
           && ((factors[23] >= 1.0e-20f) == true)
           && ((factors[33] >= 1.0e-20f) == true)
           && ((factors[42] >= 1.0e-20f) == true)
           && ((factors[50] >= 1.0e-20f) == true)
           && ((factors[57] >= 1.0e-20f) == true)
           && ((factors[63] >= 1.0e-20f) == true)
           && ((factors[68] >= 1.0e-20f) == true)
           && ((factors[72] >= 1.0e-20f) == true)
           && ((factors[75] >= 1.0e-20f) == true)
           && ((factors[77] >= 1.0e-20f) == true);
}

/* Keeps every variance of U D U' below its ceiling, by scaling its row and column, and every element of D above its
 * floor; what is added to the matrix is positive semidefinite. Each element is then compared with its bounds. */
static quadrotor_ud_status_t quadrotor_ud_hold_factors(float factors[78])
{
    static const float lowest[12] = { 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f, 1.0e-20f };
    static const float highest[12] = { 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f, 1.0e9f };
    float scale[12];
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;
    bool above = false;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 12U; i++)
    {
        float part = factors[at] / highest[i]; /* of the ceiling: the variance itself may be beyond all numbers */
        uint32_t weight = at;

        if (!((factors[at] >= 0.0f) == true))
        {
            status = QUADROTOR_UD_NOT_POSITIVE;
        }
        for (uint32_t j = i + 1U; j < 12U; j++)
        {
            const float u = factors[at + (j - i)];

            weight = weight + ((12U + 1U) - j);
            part = part + (u * (u * (factors[weight] / highest[i])));
        }
        scale[i] = 1.0f;
        if (part > 1.0f)
        {
            scale[i] = sqrtf(1.0f / part);
            above = true;
        }
        at = at + (12U - i);
    }
    if (status >= QUADROTOR_UD_OK)
    {
        if (above)
        {
            at = 0U;
            for (uint32_t i = 0U; i < 12U; i++)
            {
                factors[at] = factors[at] * (scale[i] * scale[i]);
                for (uint32_t j = i + 1U; j < 12U; j++)
                {
                    factors[at + (j - i)] = factors[at + (j - i)] * (scale[i] / scale[j]);
                }
                at = at + (12U - i);
            }
            status = QUADROTOR_UD_CLAMPED;
        }
        at = 0U;
        for (uint32_t i = 0U; i < 12U; i++)
        {
            if (factors[at] < lowest[i])
            {
                factors[at] = lowest[i];
                status = QUADROTOR_UD_CLAMPED;
            }
            at = at + (12U - i);
        }
        if (!quadrotor_ud_is_held(factors))
        {
            status = QUADROTOR_UD_OVERFLOW;
        }
    }
    return status;
}

/* Whether factors are within their bounds beyond doubt. Elements that are small, and whose sum is not far below
 * zero, are not far below zero themselves. False for NaN. */
static bool quadrotor_ud_is_bounded(const float factors[78])
{
    return ((factors[0] >= 1.0e-20f) == true)
           && ((factors[12] >= 1.0e-20f) == true)
           && ((factors[23] >= 1.0e-20f) == true)
           && ((factors[33] >= 1.0e-20f) == true)
           && ((factors[42] >= 1.0e-20f) == true)
           && ((factors[50] >= 1.0e-20f) == true)
           && ((factors[57] >= 1.0e-20f) == true)
           && ((factors[63] >= 1.0e-20f) == true)
           && ((factors[68] >= 1.0e-20f) == true)
           && ((factors[72] >= 1.0e-20f) == true)
           && ((factors[75] >= 1.0e-20f) == true)
           && ((factors[77] >= 1.0e-20f) == true)
           && (((((((((factors[0] + factors[12]) + factors[23]) + factors[33]) + factors[42]) + factors[50]) +
               factors[57]) + factors[63]) <= 490.0f) == true)
           && (((((factors[68] + factors[72]) + factors[75]) + factors[77]) <= 490.0f) == true)
           && ((factors[1] <= 62.0f) == true)
           && ((factors[2] <= 62.0f) == true)
           && ((factors[3] <= 62.0f) == true)
           && ((factors[4] <= 62.0f) == true)
           && ((factors[5] <= 62.0f) == true)
           && ((factors[6] <= 62.0f) == true)
           && ((factors[7] <= 62.0f) == true)
           && ((factors[8] <= 62.0f) == true)
           && (((((((((factors[1] + factors[2]) + factors[3]) + factors[4]) + factors[5]) + factors[6]) + factors[7]) +
               factors[8]) >= -490.0f) == true)
           && ((factors[9] <= 62.0f) == true)
           && ((factors[10] <= 62.0f) == true)
           && ((factors[11] <= 62.0f) == true)
           && ((factors[13] <= 62.0f) == true)
           && ((factors[14] <= 62.0f) == true)
           && ((factors[15] <= 62.0f) == true)
           && ((factors[16] <= 62.0f) == true)
           && ((factors[17] <= 62.0f) == true)
           && (((((((((factors[9] + factors[10]) + factors[11]) + factors[13]) + factors[14]) + factors[15]) +
               factors[16]) + factors[17]) >= -490.0f) == true)
           && ((factors[18] <= 62.0f) == true)
           && ((factors[19] <= 62.0f) == true)
           && ((factors[20] <= 62.0f) == true)
           && ((factors[21] <= 62.0f) == true)
           && ((factors[22] <= 62.0f) == true)
           && ((factors[24] <= 62.0f) == true)
           && ((factors[25] <= 62.0f) == true)
           && ((factors[26] <= 62.0f) == true)
           && (((((((((factors[18] + factors[19]) + factors[20]) + factors[21]) + factors[22]) + factors[24]) +
               factors[25]) + factors[26]) >= -490.0f) == true)
           && ((factors[27] <= 62.0f) == true)
           && ((factors[28] <= 62.0f) == true)
           && ((factors[29] <= 62.0f) == true)
           && ((factors[30] <= 62.0f) == true)
           && ((factors[31] <= 62.0f) == true)
           && ((factors[32] <= 62.0f) == true)
           && ((factors[34] <= 62.0f) == true)
           && ((factors[35] <= 62.0f) == true)
           && (((((((((factors[27] + factors[28]) + factors[29]) + factors[30]) + factors[31]) + factors[32]) +
               factors[34]) + factors[35]) >= -490.0f) == true)
           && ((factors[36] <= 62.0f) == true)
           && ((factors[37] <= 62.0f) == true)
           && ((factors[38] <= 62.0f) == true)
           && ((factors[39] <= 62.0f) == true)
           && ((factors[40] <= 62.0f) == true)
           && ((factors[41] <= 62.0f) == true)
           && ((factors[43] <= 62.0f) == true)
           && ((factors[44] <= 62.0f) == true)
           && (((((((((factors[36] + factors[37]) + factors[38]) + factors[39]) + factors[40]) + factors[41]) +
               factors[43]) + factors[44]) >= -490.0f) == true)
           && ((factors[45] <= 62.0f) == true)
           && ((factors[46] <= 62.0f) == true)
           && ((factors[47] <= 62.0f) == true)
           && ((factors[48] <= 62.0f) == true)
           && ((factors[49] <= 62.0f) == true)
           && ((factors[51] <= 62.0f) == true)
           && ((factors[52] <= 62.0f) == true)
           && ((factors[53] <= 62.0f) == true)
           && (((((((((factors[45] + factors[46]) + factors[47]) + factors[48]) + factors[49]) + factors[51]) +
               factors[52]) + factors[53]) >= -490.0f) == true)
           && ((factors[54] <= 62.0f) == true)
           && ((factors[55] <= 62.0f) == true)
           && ((factors[56] <= 62.0f) == true)
           && ((factors[58] <= 62.0f) == true)
           && ((factors[59] <= 62.0f) == true)
           && ((factors[60] <= 62.0f) == true)
           && ((factors[61] <= 62.0f) == true)
           && ((factors[62] <= 62.0f) == true)
           && (((((((((factors[54] + factors[55]) + factors[56]) + factors[58]) + factors[59]) + factors[60]) +
               factors[61]) + factors[62]) >= -490.0f) == true)
           && ((factors[64] <= 62.0f) == true)
           && ((factors[65] <= 62.0f) == true)
           && ((factors[66] <= 62.0f) == true)
           && ((factors[67] <= 62.0f) == true)
           && ((factors[69] <= 62.0f) == true)
           && ((factors[70] <= 62.0f) == true)
           && ((factors[71] <= 62.0f) == true)
           && ((factors[73] <= 62.0f) == true)
           && (((((((((factors[64] + factors[65]) + factors[66]) + factors[67]) + factors[69]) + factors[70]) +
               factors[71]) + factors[73]) >= -490.0f) == true)
           && ((factors[74] <= 240.0f) == true)
           && ((factors[76] <= 240.0f) == true)
           && (((factors[74] + factors[76]) >= -490.0f) == true);
}

static quadrotor_ud_status_t quadrotor_ud_init_core(quadrotor_ud_state_t *after, const quadrotor_ud_params_t *params)
{
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;

    if (!(((params->variance_step_x >= 0.0f) == true) && ((params->variance_step_x <= 1000000.0f) == true)
          && ((params->variance_step_vx >= 0.0f) == true) && ((params->variance_step_vx <= 1000000.0f) == true)
          && ((params->variance_step_y >= 0.0f) == true) && ((params->variance_step_y <= 1000000.0f) == true)
          && ((params->variance_step_vy >= 0.0f) == true) && ((params->variance_step_vy <= 1000000.0f) == true)
          && ((params->variance_step_z >= 0.0f) == true) && ((params->variance_step_z <= 1000000.0f) == true)
          && ((params->variance_step_vz >= 0.0f) == true) && ((params->variance_step_vz <= 1000000.0f) == true)
          && ((params->variance_step_roll >= 0.0f) == true) && ((params->variance_step_roll <= 1000000.0f) == true)
          && ((params->variance_step_roll_rate >= 0.0f) == true)
          && ((params->variance_step_roll_rate <= 1000000.0f) == true)
          && ((params->variance_step_pitch >= 0.0f) == true) && ((params->variance_step_pitch <= 1000000.0f) == true)
          && ((params->variance_step_pitch_rate >= 0.0f) == true)
          && ((params->variance_step_pitch_rate <= 1000000.0f) == true) && ((params->variance_step_yaw >= 0.0f) == true)
          && ((params->variance_step_yaw <= 1000000.0f) == true) && ((params->variance_step_yaw_rate >= 0.0f) == true)
          && ((params->variance_step_yaw_rate <= 1000000.0f) == true)
          && ((params->variance_pose[0] >= 1.0e-12f) == true) && ((params->variance_pose[0] <= 1000000.0f) == true)
          && ((params->variance_pose[1] >= 1.0e-12f) == true) && ((params->variance_pose[1] <= 1000000.0f) == true)
          && ((params->variance_pose[2] >= 1.0e-12f) == true) && ((params->variance_pose[2] <= 1000000.0f) == true)
          && ((params->variance_pose[3] >= 1.0e-12f) == true) && ((params->variance_pose[3] <= 1000000.0f) == true)
          && ((params->variance_pose[4] >= 1.0e-12f) == true) && ((params->variance_pose[4] <= 1000000.0f) == true)
          && ((params->variance_pose[5] >= 1.0e-12f) == true) && ((params->variance_pose[5] <= 1000000.0f) == true)
          && ((params->gate_pose >= 0.0f) == true) && ((params->gate_pose <= 1000000.0f) == true)
          && ((params->inflation >= 1.0f) == true) && ((params->inflation <= 1000000.0f) == true)
          && ((params->x_0 >= -10000.0f) == true) && ((params->x_0 <= 10000.0f) == true)
          && ((params->vx_0 >= -1000.0f) == true) && ((params->vx_0 <= 1000.0f) == true)
          && ((params->y_0 >= -10000.0f) == true) && ((params->y_0 <= 10000.0f) == true)
          && ((params->vy_0 >= -1000.0f) == true) && ((params->vy_0 <= 1000.0f) == true)
          && ((params->z_0 >= -10000.0f) == true) && ((params->z_0 <= 10000.0f) == true)
          && ((params->vz_0 >= -1000.0f) == true) && ((params->vz_0 <= 1000.0f) == true)
          && ((params->roll_0 >= -30.0f) == true) && ((params->roll_0 <= 30.0f) == true)
          && ((params->roll_rate_0 >= -100.0f) == true) && ((params->roll_rate_0 <= 100.0f) == true)
          && ((params->pitch_0 >= -30.0f) == true) && ((params->pitch_0 <= 30.0f) == true)
          && ((params->pitch_rate_0 >= -100.0f) == true) && ((params->pitch_rate_0 <= 100.0f) == true)
          && ((params->yaw_0 >= -30.0f) == true) && ((params->yaw_0 <= 30.0f) == true)
          && ((params->yaw_rate_0 >= -100.0f) == true) && ((params->yaw_rate_0 <= 100.0f) == true)
          && ((params->variance_x_0 >= 1.0e-12f) == true) && ((params->variance_x_0 <= 1000000.0f) == true)
          && ((params->variance_vx_0 >= 1.0e-12f) == true) && ((params->variance_vx_0 <= 1000000.0f) == true)
          && ((params->variance_y_0 >= 1.0e-12f) == true) && ((params->variance_y_0 <= 1000000.0f) == true)
          && ((params->variance_vy_0 >= 1.0e-12f) == true) && ((params->variance_vy_0 <= 1000000.0f) == true)
          && ((params->variance_z_0 >= 1.0e-12f) == true) && ((params->variance_z_0 <= 1000000.0f) == true)
          && ((params->variance_vz_0 >= 1.0e-12f) == true) && ((params->variance_vz_0 <= 1000000.0f) == true)
          && ((params->variance_roll_0 >= 1.0e-12f) == true) && ((params->variance_roll_0 <= 1000000.0f) == true)
          && ((params->variance_roll_rate_0 >= 1.0e-12f) == true)
          && ((params->variance_roll_rate_0 <= 1000000.0f) == true) && ((params->variance_pitch_0 >= 1.0e-12f) == true)
          && ((params->variance_pitch_0 <= 1000000.0f) == true) && ((params->variance_pitch_rate_0 >= 1.0e-12f) == true)
          && ((params->variance_pitch_rate_0 <= 1000000.0f) == true) && ((params->variance_yaw_0 >= 1.0e-12f) == true)
          && ((params->variance_yaw_0 <= 1000000.0f) == true) && ((params->variance_yaw_rate_0 >= 1.0e-12f) == true)
          && ((params->variance_yaw_rate_0 <= 1000000.0f) == true)))
    {
        status = QUADROTOR_UD_BAD_PARAM;
    }
    else
    {
        after->x = params->x_0;
        after->vx = params->vx_0;
        after->y = params->y_0;
        after->vy = params->vy_0;
        after->z = params->z_0;
        after->vz = params->vz_0;
        after->roll = params->roll_0;
        after->roll_rate = params->roll_rate_0;
        after->pitch = params->pitch_0;
        after->pitch_rate = params->pitch_rate_0;
        after->yaw = params->yaw_0;
        after->yaw_rate = params->yaw_rate_0;
        for (uint32_t i = 0U; i < 78U; i++)
        {
            after->factors[i] = 0.0f;
        }
        after->factors[0] = params->variance_x_0;
        after->factors[12] = params->variance_vx_0;
        after->factors[23] = params->variance_y_0;
        after->factors[33] = params->variance_vy_0;
        after->factors[42] = params->variance_z_0;
        after->factors[50] = params->variance_vz_0;
        after->factors[57] = params->variance_roll_0;
        after->factors[63] = params->variance_roll_rate_0;
        after->factors[68] = params->variance_pitch_0;
        after->factors[72] = params->variance_pitch_rate_0;
        after->factors[75] = params->variance_yaw_0;
        after->factors[77] = params->variance_yaw_rate_0;
        after->rejected_pose = 0U;

        /* judge, then commit */
        if (!quadrotor_ud_is_bounded(after->factors))
        {
            status = quadrotor_ud_hold_factors(after->factors);
        }
    }
    return status;
}

/* 670 additions, 1006 multiplications, 68 divisions, 16 negations, 14 selections, cosf 3 times, sinf 3 times. */
static quadrotor_ud_status_t quadrotor_ud_predict_judged(const quadrotor_ud_state_t *before,
                                                         quadrotor_ud_state_t *after,
                                                         const quadrotor_ud_params_t *params, const float rotor_1,
                                                         const float rotor_2, const float rotor_3, const float rotor_4)
{
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;

    after->rejected_pose = before->rejected_pose;

    /* x, F = dx/dx and Q over one step, by euler */
    /* x' = vx */
    /* vx' = (sin(yaw) sin(roll) + cos(yaw) sin(pitch)) cos(roll) (5.42e-05 (rotor_1^2 + rotor_2^2 + rotor_3^2 +
     * rotor_4^2)) */
    /* y' = vy */
    /* vy' = (sin(yaw) sin(pitch) - cos(yaw) sin(roll)) cos(roll) (5.42e-05 (rotor_1^2 + rotor_2^2 + rotor_3^2 +
     * rotor_4^2)) */
    /* z' = vz */
    /* vz' = cos(pitch) cos(roll) (5.42e-05 (rotor_1^2 + rotor_2^2 + rotor_3^2 + rotor_4^2)) - 9.81 */
    /* roll' = roll_rate */
    /* roll_rate' = -0.753086419753 (pitch_rate yaw_rate) - 0.0128395061728 pitch_rate (rotor_1 - rotor_2 + rotor_3 -
     * rotor_4) + 0.00160592592593 (rotor_3^2 - (rotor_1^2 + rotor_2^2) + rotor_4^2) */
    /* pitch' = pitch_rate */
    /* pitch_rate' = 0.753086419753 (roll_rate yaw_rate) + 0.0128395061728 roll_rate (rotor_1 - rotor_2 + rotor_3 -
     * rotor_4) + 0.00160592592593 (rotor_2^2 - rotor_1^2 + rotor_3^2 - rotor_4^2) */
    /* yaw' = yaw_rate */
    /* yaw_rate' = 1.1e-06 (rotor_1^2 - rotor_2^2 + rotor_3^2 - rotor_4^2) / 0.0142 */
    const float vx = before->vx;
    after->x = before->x + (vx * 0.025f);
    const float yaw = before->yaw;
    const float v = quadrotor_ud_math_sin(yaw);
    const float roll = before->roll;
    const float v_2 = quadrotor_ud_math_sin(roll);
    const float v_3 = quadrotor_ud_math_cos(yaw);
    const float pitch = before->pitch;
    const float v_4 = quadrotor_ud_math_sin(pitch);
    const float v_5 = (v * v_2) + (v_3 * v_4);
    const float v_6 = quadrotor_ud_math_cos(roll);
    const float v_7 = rotor_1 * rotor_1;
    const float v_8 = rotor_2 * rotor_2;
    const float v_9 = v_7 + v_8;
    const float v_10 = rotor_3 * rotor_3;
    const float v_11 = rotor_4 * rotor_4;
    const float v_12 = 0.0000542f * ((v_9 + v_10) + v_11);
    const float f_3_10 = 0.025f * ((v_5 * v_6) * v_12);
    after->vx = vx + f_3_10;
    const float vy = before->vy;
    after->y = before->y + (vy * 0.025f);
    const float v_13 = v * v_4;
    const float v_14 = v_2 * v_3;
    const float v_15 = v_13 - v_14;
    after->vy = vy + (0.025f * (v_12 * (v_6 * v_15)));
    const float vz = before->vz;
    after->z = before->z + (vz * 0.025f);
    const float v_16 = quadrotor_ud_math_cos(pitch);
    after->vz = vz + (0.025f * ((v_12 * (v_6 * v_16)) - 9.81f));
    const float roll_rate = before->roll_rate;
    after->roll = roll + (roll_rate * 0.025f);
    const float pitch_rate = before->pitch_rate;
    const float yaw_rate = before->yaw_rate;
    const float v_17 = (rotor_3 + (rotor_1 - rotor_2)) - rotor_4;
    const float v_18 = ((-((pitch_rate * yaw_rate) * 0.75308645f)) - ((pitch_rate * 0.012839506f) * v_17)) +
        (0.001605926f * (v_11 + (v_10 - v_9)));
    after->roll_rate = roll_rate + (0.025f * v_18);
    after->pitch = pitch + (pitch_rate * 0.025f);
    const float v_19 = ((0.75308645f * (roll_rate * yaw_rate)) + (v_17 * (roll_rate * 0.012839506f))) + (0.001605926f *
        ((v_10 + (v_8 - v_7)) - v_11));
    after->pitch_rate = pitch_rate + (0.025f * v_19);
    after->yaw = yaw + (yaw_rate * 0.025f);
    after->yaw_rate = yaw_rate + (0.025f * ((1.1e-6f * ((v_10 + (v_7 - v_8)) - v_11)) * 70.42254f));
    const float f_1_6 = 0.025f * (v_12 * ((v_6 * (v * v_6)) - (v_2 * v_5)));
    const float f_1_8 = 0.025f * (v_12 * (v_6 * (v_3 * v_16)));
    const float f_1_10 = 0.025f * (v_12 * (v_6 * (v_14 - v_13)));
    const float f_3_6 = -(0.025f * (v_12 * ((v_6 * (v_3 * v_6)) + (v_2 * v_15))));
    const float f_3_8 = 0.025f * (v_12 * (v_6 * (v * v_16)));
    const float f_5_6 = -(0.025f * (v_12 * (v_2 * v_16)));
    const float f_5_8 = -(0.025f * (v_12 * (v_4 * v_6)));
    const float v_20 = yaw_rate * 0.75308645f;
    const float v_21 = 0.012839506f * v_17;
    const float f_7_9 = 0.025f * ((-v_20) - v_21);
    const float f_7_11 = -(pitch_rate * 0.01882716f);
    const float f_9_7 = 0.025f * (v_20 + v_21);
    const float f_9_11 = roll_rate * 0.01882716f;

    /* U D U' = F U D U' F' + Q, by rotations of columns weighted with D and Q */
    {
        const float q_11_11 = params->variance_step_yaw_rate;
        const float d_11 = before->factors[77];
        const float t = q_11_11 + d_11;
        after->factors[77] = t;
        const float u_1_11 = before->factors[22];
        const float v_22 = before->factors[11] + (0.025f * u_1_11);
        const float per_t = 1.0f / t;
        const float kept = d_11 * per_t;
        after->factors[11] = v_22 * kept;
        const float u_6_11 = before->factors[62];
        const float u_8_11 = before->factors[71];
        const float u_10_11 = before->factors[76];
        const float v_23 = ((u_1_11 + (f_1_6 * u_6_11)) + (f_1_8 * u_8_11)) + (f_1_10 * u_10_11);
        after->factors[22] = v_23 * kept;
        const float u_3_11 = before->factors[41];
        const float v_24 = before->factors[32] + (0.025f * u_3_11);
        after->factors[32] = v_24 * kept;
        const float v_25 = ((u_3_11 + (f_3_6 * u_6_11)) + (f_3_8 * u_8_11)) + (f_3_10 * u_10_11);
        after->factors[41] = v_25 * kept;
        const float u_5_11 = before->factors[56];
        const float v_26 = before->factors[49] + (0.025f * u_5_11);
        after->factors[49] = v_26 * kept;
        const float v_27 = (u_5_11 + (f_5_6 * u_6_11)) + (f_5_8 * u_8_11);
        after->factors[56] = v_27 * kept;
        const float u_7_11 = before->factors[67];
        const float v_28 = u_6_11 + (0.025f * u_7_11);
        after->factors[62] = v_28 * kept;
        const float u_9_11 = before->factors[74];
        const float v_29 = f_7_11 + (u_7_11 + (f_7_9 * u_9_11));
        after->factors[67] = v_29 * kept;
        const float v_30 = u_8_11 + (0.025f * u_9_11);
        after->factors[71] = v_30 * kept;
        const float v_31 = f_9_11 + (u_9_11 + (f_9_7 * u_7_11));
        after->factors[74] = v_31 * kept;
        const float v_32 = 0.025f + u_10_11;
        after->factors[76] = v_32 * kept;
        const float q_10_10 = params->variance_step_yaw;
        const float d_10 = before->factors[75];
        const float w = q_11_11 * kept;
        const float v_33 = v_32 * w;
        const float t_2 = d_10 + (v_32 * v_33);
        const float t_3 = q_10_10 + t_2;
        after->factors[75] = t_3;
        const float u_1_10 = before->factors[21];
        const float v_34 = before->factors[10] + (0.025f * u_1_10);
        const float per_t_2 = 1.0f / t_2;
        const float gain = v_33 * per_t_2;
        const float v_35 = (v_34 * v_32) - v_22;
        const float v_36 = v_34 - (gain * v_35);
        const float per_t_3 = 1.0f / t_3;
        const float kept_2 = t_2 * per_t_3;
        after->factors[10] = v_36 * kept_2;
        const float u_6_10 = before->factors[61];
        const float u_8_10 = before->factors[70];
        const float v_37 = f_1_10 + ((u_1_10 + (f_1_6 * u_6_10)) + (f_1_8 * u_8_10));
        const float v_38 = (v_37 * v_32) - v_23;
        const float v_39 = v_37 - (gain * v_38);
        after->factors[21] = v_39 * kept_2;
        const float u_3_10 = before->factors[40];
        const float v_40 = before->factors[31] + (0.025f * u_3_10);
        const float v_41 = (v_40 * v_32) - v_24;
        const float v_42 = v_40 - (gain * v_41);
        after->factors[31] = v_42 * kept_2;
        const float v_43 = f_3_10 + ((u_3_10 + (f_3_6 * u_6_10)) + (f_3_8 * u_8_10));
        const float v_44 = (v_43 * v_32) - v_25;
        const float v_45 = v_43 - (gain * v_44);
        after->factors[40] = v_45 * kept_2;
        const float u_5_10 = before->factors[55];
        const float v_46 = before->factors[48] + (0.025f * u_5_10);
        const float v_47 = (v_46 * v_32) - v_26;
        const float v_48 = v_46 - (gain * v_47);
        after->factors[48] = v_48 * kept_2;
        const float v_49 = (u_5_10 + (f_5_6 * u_6_10)) + (f_5_8 * u_8_10);
        const float v_50 = (v_49 * v_32) - v_27;
        const float v_51 = v_49 - (gain * v_50);
        after->factors[55] = v_51 * kept_2;
        const float u_7_10 = before->factors[66];
        const float v_52 = u_6_10 + (0.025f * u_7_10);
        const float v_53 = (v_52 * v_32) - v_28;
        const float v_54 = v_52 - (gain * v_53);
        after->factors[61] = v_54 * kept_2;
        const float u_9_10 = before->factors[73];
        const float v_55 = u_7_10 + (f_7_9 * u_9_10);
        const float v_56 = (v_55 * v_32) - v_29;
        const float v_57 = v_55 - (gain * v_56);
        after->factors[66] = v_57 * kept_2;
        const float v_58 = u_8_10 + (0.025f * u_9_10);
        const float v_59 = (v_58 * v_32) - v_30;
        const float v_60 = v_58 - (gain * v_59);
        after->factors[70] = v_60 * kept_2;
        const float v_61 = u_9_10 + (f_9_7 * u_7_10);
        const float v_62 = (v_61 * v_32) - v_31;
        const float v_63 = v_61 - (gain * v_62);
        after->factors[73] = v_63 * kept_2;
        const float q_9_9 = params->variance_step_pitch_rate;
        const float d_7 = before->factors[63];
        const float v_64 = f_9_7 * d_7;
        const float t_4 = q_9_9 + (f_9_7 * v_64);
        const float u_7_8 = before->factors[64];
        const float v_65 = f_9_7 * u_7_8;
        const float d_8 = before->factors[68];
        const float v_66 = d_8 * v_65;
        const float t_5 = t_4 + (v_65 * v_66);
        const float u_7_9 = before->factors[65];
        const float v_67 = 1.0f + (f_9_7 * u_7_9);
        const float d_9 = before->factors[72];
        const float v_68 = d_9 * v_67;
        const float t_6 = t_5 + (v_67 * v_68);
        const float kept_3 = d_10 * per_t_2;
        const float w_2 = w * kept_3;
        const float v_69 = w_2 * v_62;
        const float t_7 = t_6 + (v_62 * v_69);
        const float w_3 = q_10_10 * kept_2;
        const float v_70 = v_63 * w_3;
        const float t_8 = t_7 + (v_63 * v_70);
        after->factors[72] = t_8;
        const float u_1_7 = before->factors[18];
        const float v_71 = before->factors[7] + (0.025f * u_1_7);
        const float per_t_4 = 1.0f / ((t_4 >= 1.0e-30f) ? t_4 : 1.0f);
        const float gain_2 = v_64 * per_t_4;
        const float v_72 = v_71 * gain_2;
        const float per_t_5 = 1.0f / ((t_5 >= 1.0e-30f) ? t_5 : 1.0f);
        const float gain_3 = v_66 * per_t_5;
        const float u_1_8 = before->factors[19];
        const float v_73 = (v_65 * v_72) - (before->factors[8] + (0.025f * u_1_8));
        const float v_74 = v_72 - (gain_3 * v_73);
        const float per_t_6 = 1.0f / ((t_6 >= 1.0e-30f) ? t_6 : 1.0f);
        const float gain_4 = v_68 * per_t_6;
        const float u_1_9 = before->factors[20];
        const float v_75 = (v_67 * v_74) - (before->factors[9] + (0.025f * u_1_9));
        const float v_76 = v_74 - (gain_4 * v_75);
        const float per_t_7 = 1.0f / ((t_7 >= 1.0e-30f) ? t_7 : 1.0f);
        const float gain_5 = v_69 * per_t_7;
        const float v_77 = (v_62 * v_76) - v_35;
        const float v_78 = v_76 - (gain_5 * v_77);
        const float per_t_8 = 1.0f / ((t_8 >= 1.0e-30f) ? t_8 : 1.0f);
        const float gain_6 = v_70 * per_t_8;
        const float v_79 = (v_63 * v_78) - v_36;
        after->factors[9] = v_78 - (gain_6 * v_79);
        const float u_6_7 = before->factors[58];
        const float v_80 = u_1_7 + (f_1_6 * u_6_7);
        const float v_81 = v_80 * gain_2;
        const float u_6_8 = before->factors[59];
        const float v_82 = (v_65 * v_81) - (f_1_8 + (u_1_8 + (f_1_6 * u_6_8)));
        const float v_83 = v_81 - (gain_3 * v_82);
        const float u_6_9 = before->factors[60];
        const float u_8_9 = before->factors[69];
        const float v_84 = (v_67 * v_83) - ((u_1_9 + (f_1_6 * u_6_9)) + (f_1_8 * u_8_9));
        const float v_85 = v_83 - (gain_4 * v_84);
        const float v_86 = (v_62 * v_85) - v_38;
        const float v_87 = v_85 - (gain_5 * v_86);
        const float v_88 = (v_63 * v_87) - v_39;
        after->factors[20] = v_87 - (gain_6 * v_88);
        const float u_3_7 = before->factors[37];
        const float v_89 = before->factors[28] + (0.025f * u_3_7);
        const float v_90 = v_89 * gain_2;
        const float u_3_8 = before->factors[38];
        const float v_91 = (v_65 * v_90) - (before->factors[29] + (0.025f * u_3_8));
        const float v_92 = v_90 - (gain_3 * v_91);
        const float u_3_9 = before->factors[39];
        const float v_93 = (v_67 * v_92) - (before->factors[30] + (0.025f * u_3_9));
        const float v_94 = v_92 - (gain_4 * v_93);
        const float v_95 = (v_62 * v_94) - v_41;
        const float v_96 = v_94 - (gain_5 * v_95);
        const float v_97 = (v_63 * v_96) - v_42;
        after->factors[30] = v_96 - (gain_6 * v_97);
        const float v_98 = u_3_7 + (f_3_6 * u_6_7);
        const float v_99 = v_98 * gain_2;
        const float v_100 = (v_65 * v_99) - (f_3_8 + (u_3_8 + (f_3_6 * u_6_8)));
        const float v_101 = v_99 - (gain_3 * v_100);
        const float v_102 = (v_67 * v_101) - ((u_3_9 + (f_3_6 * u_6_9)) + (f_3_8 * u_8_9));
        const float v_103 = v_101 - (gain_4 * v_102);
        const float v_104 = (v_62 * v_103) - v_44;
        const float v_105 = v_103 - (gain_5 * v_104);
        const float v_106 = (v_63 * v_105) - v_45;
        after->factors[39] = v_105 - (gain_6 * v_106);
        const float u_5_7 = before->factors[52];
        const float v_107 = before->factors[45] + (0.025f * u_5_7);
        const float v_108 = v_107 * gain_2;
        const float u_5_8 = before->factors[53];
        const float v_109 = (v_65 * v_108) - (before->factors[46] + (0.025f * u_5_8));
        const float v_110 = v_108 - (gain_3 * v_109);
        const float u_5_9 = before->factors[54];
        const float v_111 = (v_67 * v_110) - (before->factors[47] + (0.025f * u_5_9));
        const float v_112 = v_110 - (gain_4 * v_111);
        const float v_113 = (v_62 * v_112) - v_47;
        const float v_114 = v_112 - (gain_5 * v_113);
        const float v_115 = (v_63 * v_114) - v_48;
        after->factors[47] = v_114 - (gain_6 * v_115);
        const float v_116 = u_5_7 + (f_5_6 * u_6_7);
        const float v_117 = v_116 * gain_2;
        const float v_118 = (v_65 * v_117) - (f_5_8 + (u_5_8 + (f_5_6 * u_6_8)));
        const float v_119 = v_117 - (gain_3 * v_118);
        const float v_120 = (v_67 * v_119) - ((u_5_9 + (f_5_6 * u_6_9)) + (f_5_8 * u_8_9));
        const float v_121 = v_119 - (gain_4 * v_120);
        const float v_122 = (v_62 * v_121) - v_50;
        const float v_123 = v_121 - (gain_5 * v_122);
        const float v_124 = (v_63 * v_123) - v_51;
        after->factors[54] = v_123 - (gain_6 * v_124);
        const float v_125 = 0.025f + u_6_7;
        const float v_126 = v_125 * gain_2;
        const float v_127 = (v_65 * v_126) - (u_6_8 + (0.025f * u_7_8));
        const float v_128 = v_126 - (gain_3 * v_127);
        const float v_129 = (v_67 * v_128) - (u_6_9 + (0.025f * u_7_9));
        const float v_130 = v_128 - (gain_4 * v_129);
        const float v_131 = (v_62 * v_130) - v_53;
        const float v_132 = v_130 - (gain_5 * v_131);
        const float v_133 = (v_63 * v_132) - v_54;
        after->factors[60] = v_132 - (gain_6 * v_133);
        const float v_134 = (v_65 * gain_2) - u_7_8;
        const float v_135 = gain_2 - (gain_3 * v_134);
        const float v_136 = (v_67 * v_135) - (f_7_9 + u_7_9);
        const float v_137 = v_135 - (gain_4 * v_136);
        const float v_138 = (v_62 * v_137) - v_56;
        const float v_139 = v_137 - (gain_5 * v_138);
        const float v_140 = (v_63 * v_139) - v_57;
        after->factors[65] = v_139 - (gain_6 * v_140);
        const float v_141 = (v_67 * gain_3) - (0.025f + u_8_9);
        const float v_142 = gain_3 - (gain_4 * v_141);
        const float v_143 = (v_62 * v_142) - v_59;
        const float v_144 = v_142 - (gain_5 * v_143);
        const float v_145 = (v_63 * v_144) - v_60;
        after->factors[69] = v_144 - (gain_6 * v_145);
        const float q_8_8 = params->variance_step_pitch;
        const float kept_4 = t_4 * per_t_5;
        const float w_4 = d_8 * kept_4;
        const float t_9 = q_8_8 + w_4;
        const float kept_5 = t_5 * per_t_6;
        const float w_5 = d_9 * kept_5;
        const float v_146 = w_5 * v_141;
        const float t_10 = t_9 + (v_141 * v_146);
        const float kept_6 = t_6 * per_t_7;
        const float w_6 = w_2 * kept_6;
        const float v_147 = w_6 * v_143;
        const float t_11 = t_10 + (v_143 * v_147);
        const float kept_7 = t_7 * per_t_8;
        const float w_7 = w_3 * kept_7;
        const float v_148 = w_7 * v_145;
        const float t_12 = t_11 + (v_145 * v_148);
        after->factors[68] = t_12;
        const float per_t_9 = 1.0f / ((t_9 >= 1.0e-30f) ? t_9 : 1.0f);
        const float gain_7 = (-w_4) * per_t_9;
        const float v_149 = v_73 * gain_7;
        const float per_t_10 = 1.0f / ((t_10 >= 1.0e-30f) ? t_10 : 1.0f);
        const float gain_8 = v_146 * per_t_10;
        const float v_150 = (v_141 * v_149) - v_75;
        const float v_151 = v_149 - (gain_8 * v_150);
        const float per_t_11 = 1.0f / ((t_11 >= 1.0e-30f) ? t_11 : 1.0f);
        const float gain_9 = v_147 * per_t_11;
        const float v_152 = (v_143 * v_151) - v_77;
        const float v_153 = v_151 - (gain_9 * v_152);
        const float per_t_12 = 1.0f / ((t_12 >= 1.0e-30f) ? t_12 : 1.0f);
        const float gain_10 = v_148 * per_t_12;
        const float v_154 = (v_145 * v_153) - v_79;
        after->factors[8] = v_153 - (gain_10 * v_154);
        const float v_155 = v_82 * gain_7;
        const float v_156 = (v_141 * v_155) - v_84;
        const float v_157 = v_155 - (gain_8 * v_156);
        const float v_158 = (v_143 * v_157) - v_86;
        const float v_159 = v_157 - (gain_9 * v_158);
        const float v_160 = (v_145 * v_159) - v_88;
        after->factors[19] = v_159 - (gain_10 * v_160);
        const float v_161 = v_91 * gain_7;
        const float v_162 = (v_141 * v_161) - v_93;
        const float v_163 = v_161 - (gain_8 * v_162);
        const float v_164 = (v_143 * v_163) - v_95;
        const float v_165 = v_163 - (gain_9 * v_164);
        const float v_166 = (v_145 * v_165) - v_97;
        after->factors[29] = v_165 - (gain_10 * v_166);
        const float v_167 = v_100 * gain_7;
        const float v_168 = (v_141 * v_167) - v_102;
        const float v_169 = v_167 - (gain_8 * v_168);
        const float v_170 = (v_143 * v_169) - v_104;
        const float v_171 = v_169 - (gain_9 * v_170);
        const float v_172 = (v_145 * v_171) - v_106;
        after->factors[38] = v_171 - (gain_10 * v_172);
        const float v_173 = v_109 * gain_7;
        const float v_174 = (v_141 * v_173) - v_111;
        const float v_175 = v_173 - (gain_8 * v_174);
        const float v_176 = (v_143 * v_175) - v_113;
        const float v_177 = v_175 - (gain_9 * v_176);
        const float v_178 = (v_145 * v_177) - v_115;
        after->factors[46] = v_177 - (gain_10 * v_178);
        const float v_179 = v_118 * gain_7;
        const float v_180 = (v_141 * v_179) - v_120;
        const float v_181 = v_179 - (gain_8 * v_180);
        const float v_182 = (v_143 * v_181) - v_122;
        const float v_183 = v_181 - (gain_9 * v_182);
        const float v_184 = (v_145 * v_183) - v_124;
        after->factors[53] = v_183 - (gain_10 * v_184);
        const float v_185 = v_127 * gain_7;
        const float v_186 = (v_141 * v_185) - v_129;
        const float v_187 = v_185 - (gain_8 * v_186);
        const float v_188 = (v_143 * v_187) - v_131;
        const float v_189 = v_187 - (gain_9 * v_188);
        const float v_190 = (v_145 * v_189) - v_133;
        after->factors[59] = v_189 - (gain_10 * v_190);
        const float v_191 = v_134 * gain_7;
        const float v_192 = (v_141 * v_191) - v_136;
        const float v_193 = v_191 - (gain_8 * v_192);
        const float v_194 = (v_143 * v_193) - v_138;
        const float v_195 = v_193 - (gain_9 * v_194);
        const float v_196 = (v_145 * v_195) - v_140;
        after->factors[64] = v_195 - (gain_10 * v_196);
        const float q_7_7 = params->variance_step_roll_rate;
        const float kept_8 = q_9_9 * per_t_4;
        const float w_8 = d_7 * kept_8;
        const float t_13 = q_7_7 + w_8;
        const float v_197 = -v_134;
        const float kept_9 = q_8_8 * per_t_9;
        const float w_9 = w_4 * kept_9;
        const float v_198 = w_9 * v_197;
        const float t_14 = t_13 + (v_197 * v_198);
        const float kept_10 = t_9 * per_t_10;
        const float w_10 = w_5 * kept_10;
        const float v_199 = w_10 * v_192;
        const float t_15 = t_14 + (v_192 * v_199);
        const float kept_11 = t_10 * per_t_11;
        const float w_11 = w_6 * kept_11;
        const float v_200 = w_11 * v_194;
        const float t_16 = t_15 + (v_194 * v_200);
        const float kept_12 = t_11 * per_t_12;
        const float w_12 = w_7 * kept_12;
        const float v_201 = w_12 * v_196;
        const float t_17 = t_16 + (v_196 * v_201);
        after->factors[63] = t_17;
        const float per_t_13 = 1.0f / ((t_13 >= 1.0e-30f) ? t_13 : 1.0f);
        const float gain_11 = (-w_8) * per_t_13;
        const float v_202 = (-v_71) * gain_11;
        const float per_t_14 = 1.0f / ((t_14 >= 1.0e-30f) ? t_14 : 1.0f);
        const float gain_12 = v_198 * per_t_14;
        const float v_203 = v_73 + (v_197 * v_202);
        const float v_204 = v_202 - (gain_12 * v_203);
        const float per_t_15 = 1.0f / ((t_15 >= 1.0e-30f) ? t_15 : 1.0f);
        const float gain_13 = v_199 * per_t_15;
        const float v_205 = (v_192 * v_204) - v_150;
        const float v_206 = v_204 - (gain_13 * v_205);
        const float per_t_16 = 1.0f / ((t_16 >= 1.0e-30f) ? t_16 : 1.0f);
        const float gain_14 = v_200 * per_t_16;
        const float v_207 = (v_194 * v_206) - v_152;
        const float v_208 = v_206 - (gain_14 * v_207);
        const float per_t_17 = 1.0f / ((t_17 >= 1.0e-30f) ? t_17 : 1.0f);
        const float gain_15 = v_201 * per_t_17;
        const float v_209 = (v_196 * v_208) - v_154;
        after->factors[7] = v_208 - (gain_15 * v_209);
        const float v_210 = (-v_80) * gain_11;
        const float v_211 = v_82 + (v_197 * v_210);
        const float v_212 = v_210 - (gain_12 * v_211);
        const float v_213 = (v_192 * v_212) - v_156;
        const float v_214 = v_212 - (gain_13 * v_213);
        const float v_215 = (v_194 * v_214) - v_158;
        const float v_216 = v_214 - (gain_14 * v_215);
        const float v_217 = (v_196 * v_216) - v_160;
        after->factors[18] = v_216 - (gain_15 * v_217);
        const float v_218 = (-v_89) * gain_11;
        const float v_219 = v_91 + (v_197 * v_218);
        const float v_220 = v_218 - (gain_12 * v_219);
        const float v_221 = (v_192 * v_220) - v_162;
        const float v_222 = v_220 - (gain_13 * v_221);
        const float v_223 = (v_194 * v_222) - v_164;
        const float v_224 = v_222 - (gain_14 * v_223);
        const float v_225 = (v_196 * v_224) - v_166;
        after->factors[28] = v_224 - (gain_15 * v_225);
        const float v_226 = (-v_98) * gain_11;
        const float v_227 = v_100 + (v_197 * v_226);
        const float v_228 = v_226 - (gain_12 * v_227);
        const float v_229 = (v_192 * v_228) - v_168;
        const float v_230 = v_228 - (gain_13 * v_229);
        const float v_231 = (v_194 * v_230) - v_170;
        const float v_232 = v_230 - (gain_14 * v_231);
        const float v_233 = (v_196 * v_232) - v_172;
        after->factors[37] = v_232 - (gain_15 * v_233);
        const float v_234 = (-v_107) * gain_11;
        const float v_235 = v_109 + (v_197 * v_234);
        const float v_236 = v_234 - (gain_12 * v_235);
        const float v_237 = (v_192 * v_236) - v_174;
        const float v_238 = v_236 - (gain_13 * v_237);
        const float v_239 = (v_194 * v_238) - v_176;
        const float v_240 = v_238 - (gain_14 * v_239);
        const float v_241 = (v_196 * v_240) - v_178;
        after->factors[45] = v_240 - (gain_15 * v_241);
        const float v_242 = (-v_116) * gain_11;
        const float v_243 = v_118 + (v_197 * v_242);
        const float v_244 = v_242 - (gain_12 * v_243);
        const float v_245 = (v_192 * v_244) - v_180;
        const float v_246 = v_244 - (gain_13 * v_245);
        const float v_247 = (v_194 * v_246) - v_182;
        const float v_248 = v_246 - (gain_14 * v_247);
        const float v_249 = (v_196 * v_248) - v_184;
        after->factors[52] = v_248 - (gain_15 * v_249);
        const float v_250 = (-v_125) * gain_11;
        const float v_251 = v_127 + (v_197 * v_250);
        const float v_252 = v_250 - (gain_12 * v_251);
        const float v_253 = (v_192 * v_252) - v_186;
        const float v_254 = v_252 - (gain_13 * v_253);
        const float v_255 = (v_194 * v_254) - v_188;
        const float v_256 = v_254 - (gain_14 * v_255);
        const float v_257 = (v_196 * v_256) - v_190;
        after->factors[58] = v_256 - (gain_15 * v_257);
        const float q_6_6 = params->variance_step_roll;
        const float d_6 = before->factors[57];
        const float kept_13 = q_7_7 * per_t_13;
        const float w_13 = w_8 * kept_13;
        const float v_258 = v_125 * w_13;
        const float t_18 = d_6 + (v_125 * v_258);
        const float kept_14 = t_13 * per_t_14;
        const float w_14 = w_9 * kept_14;
        const float v_259 = w_14 * v_251;
        const float t_19 = t_18 + (v_251 * v_259);
        const float kept_15 = t_14 * per_t_15;
        const float w_15 = w_10 * kept_15;
        const float v_260 = w_15 * v_253;
        const float t_20 = t_19 + (v_253 * v_260);
        const float kept_16 = t_15 * per_t_16;
        const float w_16 = w_11 * kept_16;
        const float v_261 = w_16 * v_255;
        const float t_21 = t_20 + (v_255 * v_261);
        const float kept_17 = t_16 * per_t_17;
        const float w_17 = w_12 * kept_17;
        const float v_262 = w_17 * v_257;
        const float t_22 = t_21 + (v_257 * v_262);
        const float t_23 = q_6_6 + t_22;
        after->factors[57] = t_23;
        const float u_1_6 = before->factors[17];
        const float v_263 = before->factors[6] + (0.025f * u_1_6);
        const float per_t_18 = 1.0f / t_18;
        const float gain_16 = v_258 * per_t_18;
        const float v_264 = (v_263 * v_125) - v_71;
        const float v_265 = v_263 - (gain_16 * v_264);
        const float per_t_19 = 1.0f / t_19;
        const float gain_17 = v_259 * per_t_19;
        const float v_266 = (v_251 * v_265) - v_203;
        const float v_267 = v_265 - (gain_17 * v_266);
        const float per_t_20 = 1.0f / t_20;
        const float gain_18 = v_260 * per_t_20;
        const float v_268 = (v_253 * v_267) - v_205;
        const float v_269 = v_267 - (gain_18 * v_268);
        const float per_t_21 = 1.0f / t_21;
        const float gain_19 = v_261 * per_t_21;
        const float v_270 = (v_255 * v_269) - v_207;
        const float v_271 = v_269 - (gain_19 * v_270);
        const float per_t_22 = 1.0f / t_22;
        const float gain_20 = v_262 * per_t_22;
        const float v_272 = (v_257 * v_271) - v_209;
        const float v_273 = v_271 - (gain_20 * v_272);
        const float per_t_23 = 1.0f / t_23;
        const float kept_18 = t_22 * per_t_23;
        after->factors[6] = v_273 * kept_18;
        const float v_274 = f_1_6 + u_1_6;
        const float v_275 = (v_274 * v_125) - v_80;
        const float v_276 = v_274 - (gain_16 * v_275);
        const float v_277 = (v_251 * v_276) - v_211;
        const float v_278 = v_276 - (gain_17 * v_277);
        const float v_279 = (v_253 * v_278) - v_213;
        const float v_280 = v_278 - (gain_18 * v_279);
        const float v_281 = (v_255 * v_280) - v_215;
        const float v_282 = v_280 - (gain_19 * v_281);
        const float v_283 = (v_257 * v_282) - v_217;
        const float v_284 = v_282 - (gain_20 * v_283);
        after->factors[17] = v_284 * kept_18;
        const float u_3_6 = before->factors[36];
        const float v_285 = before->factors[27] + (0.025f * u_3_6);
        const float v_286 = (v_285 * v_125) - v_89;
        const float v_287 = v_285 - (gain_16 * v_286);
        const float v_288 = (v_251 * v_287) - v_219;
        const float v_289 = v_287 - (gain_17 * v_288);
        const float v_290 = (v_253 * v_289) - v_221;
        const float v_291 = v_289 - (gain_18 * v_290);
        const float v_292 = (v_255 * v_291) - v_223;
        const float v_293 = v_291 - (gain_19 * v_292);
        const float v_294 = (v_257 * v_293) - v_225;
        const float v_295 = v_293 - (gain_20 * v_294);
        after->factors[27] = v_295 * kept_18;
        const float v_296 = f_3_6 + u_3_6;
        const float v_297 = (v_296 * v_125) - v_98;
        const float v_298 = v_296 - (gain_16 * v_297);
        const float v_299 = (v_251 * v_298) - v_227;
        const float v_300 = v_298 - (gain_17 * v_299);
        const float v_301 = (v_253 * v_300) - v_229;
        const float v_302 = v_300 - (gain_18 * v_301);
        const float v_303 = (v_255 * v_302) - v_231;
        const float v_304 = v_302 - (gain_19 * v_303);
        const float v_305 = (v_257 * v_304) - v_233;
        const float v_306 = v_304 - (gain_20 * v_305);
        after->factors[36] = v_306 * kept_18;
        const float u_5_6 = before->factors[51];
        const float v_307 = before->factors[44] + (0.025f * u_5_6);
        const float v_308 = (v_307 * v_125) - v_107;
        const float v_309 = v_307 - (gain_16 * v_308);
        const float v_310 = (v_251 * v_309) - v_235;
        const float v_311 = v_309 - (gain_17 * v_310);
        const float v_312 = (v_253 * v_311) - v_237;
        const float v_313 = v_311 - (gain_18 * v_312);
        const float v_314 = (v_255 * v_313) - v_239;
        const float v_315 = v_313 - (gain_19 * v_314);
        const float v_316 = (v_257 * v_315) - v_241;
        const float v_317 = v_315 - (gain_20 * v_316);
        after->factors[44] = v_317 * kept_18;
        const float v_318 = f_5_6 + u_5_6;
        const float v_319 = (v_318 * v_125) - v_116;
        const float v_320 = v_318 - (gain_16 * v_319);
        const float v_321 = (v_251 * v_320) - v_243;
        const float v_322 = v_320 - (gain_17 * v_321);
        const float v_323 = (v_253 * v_322) - v_245;
        const float v_324 = v_322 - (gain_18 * v_323);
        const float v_325 = (v_255 * v_324) - v_247;
        const float v_326 = v_324 - (gain_19 * v_325);
        const float v_327 = (v_257 * v_326) - v_249;
        const float v_328 = v_326 - (gain_20 * v_327);
        after->factors[51] = v_328 * kept_18;
        const float q_5_5 = params->variance_step_vz;
        const float d_5 = before->factors[50];
        const float kept_19 = d_6 * per_t_18;
        const float w_18 = w_13 * kept_19;
        const float v_329 = w_18 * v_319;
        const float t_24 = d_5 + (v_319 * v_329);
        const float kept_20 = t_18 * per_t_19;
        const float w_19 = w_14 * kept_20;
        const float v_330 = w_19 * v_321;
        const float t_25 = t_24 + (v_321 * v_330);
        const float kept_21 = t_19 * per_t_20;
        const float w_20 = w_15 * kept_21;
        const float v_331 = w_20 * v_323;
        const float t_26 = t_25 + (v_323 * v_331);
        const float kept_22 = t_20 * per_t_21;
        const float w_21 = w_16 * kept_22;
        const float v_332 = w_21 * v_325;
        const float t_27 = t_26 + (v_325 * v_332);
        const float kept_23 = t_21 * per_t_22;
        const float w_22 = w_17 * kept_23;
        const float v_333 = w_22 * v_327;
        const float t_28 = t_27 + (v_327 * v_333);
        const float w_23 = q_6_6 * kept_18;
        const float v_334 = v_328 * w_23;
        const float t_29 = t_28 + (v_328 * v_334);
        const float t_30 = q_5_5 + t_29;
        after->factors[50] = t_30;
        const float u_1_5 = before->factors[16];
        const float v_335 = before->factors[5] + (0.025f * u_1_5);
        const float per_t_24 = 1.0f / t_24;
        const float gain_21 = v_329 * per_t_24;
        const float v_336 = (v_335 * v_319) - v_264;
        const float v_337 = v_335 - (gain_21 * v_336);
        const float per_t_25 = 1.0f / t_25;
        const float gain_22 = v_330 * per_t_25;
        const float v_338 = (v_321 * v_337) - v_266;
        const float v_339 = v_337 - (gain_22 * v_338);
        const float per_t_26 = 1.0f / t_26;
        const float gain_23 = v_331 * per_t_26;
        const float v_340 = (v_323 * v_339) - v_268;
        const float v_341 = v_339 - (gain_23 * v_340);
        const float per_t_27 = 1.0f / t_27;
        const float gain_24 = v_332 * per_t_27;
        const float v_342 = (v_325 * v_341) - v_270;
        const float v_343 = v_341 - (gain_24 * v_342);
        const float per_t_28 = 1.0f / t_28;
        const float gain_25 = v_333 * per_t_28;
        const float v_344 = (v_327 * v_343) - v_272;
        const float v_345 = v_343 - (gain_25 * v_344);
        const float per_t_29 = 1.0f / t_29;
        const float gain_26 = v_334 * per_t_29;
        const float v_346 = (v_328 * v_345) - v_273;
        const float v_347 = v_345 - (gain_26 * v_346);
        const float per_t_30 = 1.0f / t_30;
        const float kept_24 = t_29 * per_t_30;
        after->factors[5] = v_347 * kept_24;
        const float v_348 = (u_1_5 * v_319) - v_275;
        const float v_349 = u_1_5 - (gain_21 * v_348);
        const float v_350 = (v_321 * v_349) - v_277;
        const float v_351 = v_349 - (gain_22 * v_350);
        const float v_352 = (v_323 * v_351) - v_279;
        const float v_353 = v_351 - (gain_23 * v_352);
        const float v_354 = (v_325 * v_353) - v_281;
        const float v_355 = v_353 - (gain_24 * v_354);
        const float v_356 = (v_327 * v_355) - v_283;
        const float v_357 = v_355 - (gain_25 * v_356);
        const float v_358 = (v_328 * v_357) - v_284;
        const float v_359 = v_357 - (gain_26 * v_358);
        after->factors[16] = v_359 * kept_24;
        const float u_3_5 = before->factors[35];
        const float v_360 = before->factors[26] + (0.025f * u_3_5);
        const float v_361 = (v_360 * v_319) - v_286;
        const float v_362 = v_360 - (gain_21 * v_361);
        const float v_363 = (v_321 * v_362) - v_288;
        const float v_364 = v_362 - (gain_22 * v_363);
        const float v_365 = (v_323 * v_364) - v_290;
        const float v_366 = v_364 - (gain_23 * v_365);
        const float v_367 = (v_325 * v_366) - v_292;
        const float v_368 = v_366 - (gain_24 * v_367);
        const float v_369 = (v_327 * v_368) - v_294;
        const float v_370 = v_368 - (gain_25 * v_369);
        const float v_371 = (v_328 * v_370) - v_295;
        const float v_372 = v_370 - (gain_26 * v_371);
        after->factors[26] = v_372 * kept_24;
        const float v_373 = (u_3_5 * v_319) - v_297;
        const float v_374 = u_3_5 - (gain_21 * v_373);
        const float v_375 = (v_321 * v_374) - v_299;
        const float v_376 = v_374 - (gain_22 * v_375);
        const float v_377 = (v_323 * v_376) - v_301;
        const float v_378 = v_376 - (gain_23 * v_377);
        const float v_379 = (v_325 * v_378) - v_303;
        const float v_380 = v_378 - (gain_24 * v_379);
        const float v_381 = (v_327 * v_380) - v_305;
        const float v_382 = v_380 - (gain_25 * v_381);
        const float v_383 = (v_328 * v_382) - v_306;
        const float v_384 = v_382 - (gain_26 * v_383);
        after->factors[35] = v_384 * kept_24;
        const float v_385 = 0.025f + before->factors[43];
        const float v_386 = (v_385 * v_319) - v_308;
        const float v_387 = v_385 - (gain_21 * v_386);
        const float v_388 = (v_321 * v_387) - v_310;
        const float v_389 = v_387 - (gain_22 * v_388);
        const float v_390 = (v_323 * v_389) - v_312;
        const float v_391 = v_389 - (gain_23 * v_390);
        const float v_392 = (v_325 * v_391) - v_314;
        const float v_393 = v_391 - (gain_24 * v_392);
        const float v_394 = (v_327 * v_393) - v_316;
        const float v_395 = v_393 - (gain_25 * v_394);
        const float v_396 = (v_328 * v_395) - v_317;
        const float v_397 = v_395 - (gain_26 * v_396);
        after->factors[43] = v_397 * kept_24;
        const float q_4_4 = params->variance_step_z;
        const float d_4 = before->factors[42];
        const float kept_25 = d_5 * per_t_24;
        const float w_24 = w_18 * kept_25;
        const float v_398 = w_24 * v_386;
        const float t_31 = d_4 + (v_386 * v_398);
        const float kept_26 = t_24 * per_t_25;
        const float w_25 = w_19 * kept_26;
        const float v_399 = w_25 * v_388;
        const float t_32 = t_31 + (v_388 * v_399);
        const float kept_27 = t_25 * per_t_26;
        const float w_26 = w_20 * kept_27;
        const float v_400 = w_26 * v_390;
        const float t_33 = t_32 + (v_390 * v_400);
        const float kept_28 = t_26 * per_t_27;
        const float w_27 = w_21 * kept_28;
        const float v_401 = w_27 * v_392;
        const float t_34 = t_33 + (v_392 * v_401);
        const float kept_29 = t_27 * per_t_28;
        const float w_28 = w_22 * kept_29;
        const float v_402 = w_28 * v_394;
        const float t_35 = t_34 + (v_394 * v_402);
        const float kept_30 = t_28 * per_t_29;
        const float w_29 = w_23 * kept_30;
        const float v_403 = w_29 * v_396;
        const float t_36 = t_35 + (v_396 * v_403);
        const float w_30 = q_5_5 * kept_24;
        const float v_404 = v_397 * w_30;
        const float t_37 = t_36 + (v_397 * v_404);
        const float t_38 = q_4_4 + t_37;
        after->factors[42] = t_38;
        const float u_1_4 = before->factors[15];
        const float v_405 = before->factors[4] + (0.025f * u_1_4);
        const float per_t_31 = 1.0f / t_31;
        const float gain_27 = v_398 * per_t_31;
        const float v_406 = (v_405 * v_386) - v_336;
        const float v_407 = v_405 - (gain_27 * v_406);
        const float per_t_32 = 1.0f / t_32;
        const float gain_28 = v_399 * per_t_32;
        const float v_408 = (v_388 * v_407) - v_338;
        const float v_409 = v_407 - (gain_28 * v_408);
        const float per_t_33 = 1.0f / t_33;
        const float gain_29 = v_400 * per_t_33;
        const float v_410 = (v_390 * v_409) - v_340;
        const float v_411 = v_409 - (gain_29 * v_410);
        const float per_t_34 = 1.0f / t_34;
        const float gain_30 = v_401 * per_t_34;
        const float v_412 = (v_392 * v_411) - v_342;
        const float v_413 = v_411 - (gain_30 * v_412);
        const float per_t_35 = 1.0f / t_35;
        const float gain_31 = v_402 * per_t_35;
        const float v_414 = (v_394 * v_413) - v_344;
        const float v_415 = v_413 - (gain_31 * v_414);
        const float per_t_36 = 1.0f / t_36;
        const float gain_32 = v_403 * per_t_36;
        const float v_416 = (v_396 * v_415) - v_346;
        const float v_417 = v_415 - (gain_32 * v_416);
        const float per_t_37 = 1.0f / t_37;
        const float gain_33 = v_404 * per_t_37;
        const float v_418 = (v_397 * v_417) - v_347;
        const float v_419 = v_417 - (gain_33 * v_418);
        const float per_t_38 = 1.0f / t_38;
        const float kept_31 = t_37 * per_t_38;
        after->factors[4] = v_419 * kept_31;
        const float v_420 = (u_1_4 * v_386) - v_348;
        const float v_421 = u_1_4 - (gain_27 * v_420);
        const float v_422 = (v_388 * v_421) - v_350;
        const float v_423 = v_421 - (gain_28 * v_422);
        const float v_424 = (v_390 * v_423) - v_352;
        const float v_425 = v_423 - (gain_29 * v_424);
        const float v_426 = (v_392 * v_425) - v_354;
        const float v_427 = v_425 - (gain_30 * v_426);
        const float v_428 = (v_394 * v_427) - v_356;
        const float v_429 = v_427 - (gain_31 * v_428);
        const float v_430 = (v_396 * v_429) - v_358;
        const float v_431 = v_429 - (gain_32 * v_430);
        const float v_432 = (v_397 * v_431) - v_359;
        const float v_433 = v_431 - (gain_33 * v_432);
        after->factors[15] = v_433 * kept_31;
        const float u_3_4 = before->factors[34];
        const float v_434 = before->factors[25] + (0.025f * u_3_4);
        const float v_435 = (v_434 * v_386) - v_361;
        const float v_436 = v_434 - (gain_27 * v_435);
        const float v_437 = (v_388 * v_436) - v_363;
        const float v_438 = v_436 - (gain_28 * v_437);
        const float v_439 = (v_390 * v_438) - v_365;
        const float v_440 = v_438 - (gain_29 * v_439);
        const float v_441 = (v_392 * v_440) - v_367;
        const float v_442 = v_440 - (gain_30 * v_441);
        const float v_443 = (v_394 * v_442) - v_369;
        const float v_444 = v_442 - (gain_31 * v_443);
        const float v_445 = (v_396 * v_444) - v_371;
        const float v_446 = v_444 - (gain_32 * v_445);
        const float v_447 = (v_397 * v_446) - v_372;
        const float v_448 = v_446 - (gain_33 * v_447);
        after->factors[25] = v_448 * kept_31;
        const float v_449 = (u_3_4 * v_386) - v_373;
        const float v_450 = u_3_4 - (gain_27 * v_449);
        const float v_451 = (v_388 * v_450) - v_375;
        const float v_452 = v_450 - (gain_28 * v_451);
        const float v_453 = (v_390 * v_452) - v_377;
        const float v_454 = v_452 - (gain_29 * v_453);
        const float v_455 = (v_392 * v_454) - v_379;
        const float v_456 = v_454 - (gain_30 * v_455);
        const float v_457 = (v_394 * v_456) - v_381;
        const float v_458 = v_456 - (gain_31 * v_457);
        const float v_459 = (v_396 * v_458) - v_383;
        const float v_460 = v_458 - (gain_32 * v_459);
        const float v_461 = (v_397 * v_460) - v_384;
        const float v_462 = v_460 - (gain_33 * v_461);
        after->factors[34] = v_462 * kept_31;
        const float q_3_3 = params->variance_step_vy;
        const float d_3 = before->factors[33];
        const float kept_32 = d_4 * per_t_31;
        const float w_31 = w_24 * kept_32;
        const float v_463 = w_31 * v_449;
        const float t_39 = d_3 + (v_449 * v_463);
        const float kept_33 = t_31 * per_t_32;
        const float w_32 = w_25 * kept_33;
        const float v_464 = w_32 * v_451;
        const float t_40 = t_39 + (v_451 * v_464);
        const float kept_34 = t_32 * per_t_33;
        const float w_33 = w_26 * kept_34;
        const float v_465 = w_33 * v_453;
        const float t_41 = t_40 + (v_453 * v_465);
        const float kept_35 = t_33 * per_t_34;
        const float w_34 = w_27 * kept_35;
        const float v_466 = w_34 * v_455;
        const float t_42 = t_41 + (v_455 * v_466);
        const float kept_36 = t_34 * per_t_35;
        const float w_35 = w_28 * kept_36;
        const float v_467 = w_35 * v_457;
        const float t_43 = t_42 + (v_457 * v_467);
        const float kept_37 = t_35 * per_t_36;
        const float w_36 = w_29 * kept_37;
        const float v_468 = w_36 * v_459;
        const float t_44 = t_43 + (v_459 * v_468);
        const float kept_38 = t_36 * per_t_37;
        const float w_37 = w_30 * kept_38;
        const float v_469 = w_37 * v_461;
        const float t_45 = t_44 + (v_461 * v_469);
        const float w_38 = q_4_4 * kept_31;
        const float v_470 = v_462 * w_38;
        const float t_46 = t_45 + (v_462 * v_470);
        const float t_47 = q_3_3 + t_46;
        after->factors[33] = t_47;
        const float u_1_3 = before->factors[14];
        const float v_471 = before->factors[3] + (0.025f * u_1_3);
        const float per_t_39 = 1.0f / t_39;
        const float gain_34 = v_463 * per_t_39;
        const float v_472 = (v_471 * v_449) - v_406;
        const float v_473 = v_471 - (gain_34 * v_472);
        const float per_t_40 = 1.0f / t_40;
        const float gain_35 = v_464 * per_t_40;
        const float v_474 = (v_451 * v_473) - v_408;
        const float v_475 = v_473 - (gain_35 * v_474);
        const float per_t_41 = 1.0f / t_41;
        const float gain_36 = v_465 * per_t_41;
        const float v_476 = (v_453 * v_475) - v_410;
        const float v_477 = v_475 - (gain_36 * v_476);
        const float per_t_42 = 1.0f / t_42;
        const float gain_37 = v_466 * per_t_42;
        const float v_478 = (v_455 * v_477) - v_412;
        const float v_479 = v_477 - (gain_37 * v_478);
        const float per_t_43 = 1.0f / t_43;
        const float gain_38 = v_467 * per_t_43;
        const float v_480 = (v_457 * v_479) - v_414;
        const float v_481 = v_479 - (gain_38 * v_480);
        const float per_t_44 = 1.0f / t_44;
        const float gain_39 = v_468 * per_t_44;
        const float v_482 = (v_459 * v_481) - v_416;
        const float v_483 = v_481 - (gain_39 * v_482);
        const float per_t_45 = 1.0f / t_45;
        const float gain_40 = v_469 * per_t_45;
        const float v_484 = (v_461 * v_483) - v_418;
        const float v_485 = v_483 - (gain_40 * v_484);
        const float per_t_46 = 1.0f / t_46;
        const float gain_41 = v_470 * per_t_46;
        const float v_486 = (v_462 * v_485) - v_419;
        const float v_487 = v_485 - (gain_41 * v_486);
        const float per_t_47 = 1.0f / t_47;
        const float kept_39 = t_46 * per_t_47;
        after->factors[3] = v_487 * kept_39;
        const float v_488 = (u_1_3 * v_449) - v_420;
        const float v_489 = u_1_3 - (gain_34 * v_488);
        const float v_490 = (v_451 * v_489) - v_422;
        const float v_491 = v_489 - (gain_35 * v_490);
        const float v_492 = (v_453 * v_491) - v_424;
        const float v_493 = v_491 - (gain_36 * v_492);
        const float v_494 = (v_455 * v_493) - v_426;
        const float v_495 = v_493 - (gain_37 * v_494);
        const float v_496 = (v_457 * v_495) - v_428;
        const float v_497 = v_495 - (gain_38 * v_496);
        const float v_498 = (v_459 * v_497) - v_430;
        const float v_499 = v_497 - (gain_39 * v_498);
        const float v_500 = (v_461 * v_499) - v_432;
        const float v_501 = v_499 - (gain_40 * v_500);
        const float v_502 = (v_462 * v_501) - v_433;
        const float v_503 = v_501 - (gain_41 * v_502);
        after->factors[14] = v_503 * kept_39;
        const float v_504 = 0.025f + before->factors[24];
        const float v_505 = (v_504 * v_449) - v_435;
        const float v_506 = v_504 - (gain_34 * v_505);
        const float v_507 = (v_451 * v_506) - v_437;
        const float v_508 = v_506 - (gain_35 * v_507);
        const float v_509 = (v_453 * v_508) - v_439;
        const float v_510 = v_508 - (gain_36 * v_509);
        const float v_511 = (v_455 * v_510) - v_441;
        const float v_512 = v_510 - (gain_37 * v_511);
        const float v_513 = (v_457 * v_512) - v_443;
        const float v_514 = v_512 - (gain_38 * v_513);
        const float v_515 = (v_459 * v_514) - v_445;
        const float v_516 = v_514 - (gain_39 * v_515);
        const float v_517 = (v_461 * v_516) - v_447;
        const float v_518 = v_516 - (gain_40 * v_517);
        const float v_519 = (v_462 * v_518) - v_448;
        const float v_520 = v_518 - (gain_41 * v_519);
        after->factors[24] = v_520 * kept_39;
        const float q_2_2 = params->variance_step_y;
        const float d_2 = before->factors[23];
        const float kept_40 = d_3 * per_t_39;
        const float w_39 = w_31 * kept_40;
        const float v_521 = w_39 * v_505;
        const float t_48 = d_2 + (v_505 * v_521);
        const float kept_41 = t_39 * per_t_40;
        const float w_40 = w_32 * kept_41;
        const float v_522 = w_40 * v_507;
        const float t_49 = t_48 + (v_507 * v_522);
        const float kept_42 = t_40 * per_t_41;
        const float w_41 = w_33 * kept_42;
        const float v_523 = w_41 * v_509;
        const float t_50 = t_49 + (v_509 * v_523);
        const float kept_43 = t_41 * per_t_42;
        const float w_42 = w_34 * kept_43;
        const float v_524 = w_42 * v_511;
        const float t_51 = t_50 + (v_511 * v_524);
        const float kept_44 = t_42 * per_t_43;
        const float w_43 = w_35 * kept_44;
        const float v_525 = w_43 * v_513;
        const float t_52 = t_51 + (v_513 * v_525);
        const float kept_45 = t_43 * per_t_44;
        const float w_44 = w_36 * kept_45;
        const float v_526 = w_44 * v_515;
        const float t_53 = t_52 + (v_515 * v_526);
        const float kept_46 = t_44 * per_t_45;
        const float w_45 = w_37 * kept_46;
        const float v_527 = w_45 * v_517;
        const float t_54 = t_53 + (v_517 * v_527);
        const float kept_47 = t_45 * per_t_46;
        const float w_46 = w_38 * kept_47;
        const float v_528 = w_46 * v_519;
        const float t_55 = t_54 + (v_519 * v_528);
        const float w_47 = q_3_3 * kept_39;
        const float v_529 = v_520 * w_47;
        const float t_56 = t_55 + (v_520 * v_529);
        const float t_57 = q_2_2 + t_56;
        after->factors[23] = t_57;
        const float u_1_2 = before->factors[13];
        const float v_530 = before->factors[2] + (0.025f * u_1_2);
        const float per_t_48 = 1.0f / t_48;
        const float gain_42 = v_521 * per_t_48;
        const float v_531 = (v_530 * v_505) - v_472;
        const float v_532 = v_530 - (gain_42 * v_531);
        const float per_t_49 = 1.0f / t_49;
        const float gain_43 = v_522 * per_t_49;
        const float v_533 = (v_507 * v_532) - v_474;
        const float v_534 = v_532 - (gain_43 * v_533);
        const float per_t_50 = 1.0f / t_50;
        const float gain_44 = v_523 * per_t_50;
        const float v_535 = (v_509 * v_534) - v_476;
        const float v_536 = v_534 - (gain_44 * v_535);
        const float per_t_51 = 1.0f / t_51;
        const float gain_45 = v_524 * per_t_51;
        const float v_537 = (v_511 * v_536) - v_478;
        const float v_538 = v_536 - (gain_45 * v_537);
        const float per_t_52 = 1.0f / t_52;
        const float gain_46 = v_525 * per_t_52;
        const float v_539 = (v_513 * v_538) - v_480;
        const float v_540 = v_538 - (gain_46 * v_539);
        const float per_t_53 = 1.0f / t_53;
        const float gain_47 = v_526 * per_t_53;
        const float v_541 = (v_515 * v_540) - v_482;
        const float v_542 = v_540 - (gain_47 * v_541);
        const float per_t_54 = 1.0f / t_54;
        const float gain_48 = v_527 * per_t_54;
        const float v_543 = (v_517 * v_542) - v_484;
        const float v_544 = v_542 - (gain_48 * v_543);
        const float per_t_55 = 1.0f / t_55;
        const float gain_49 = v_528 * per_t_55;
        const float v_545 = (v_519 * v_544) - v_486;
        const float v_546 = v_544 - (gain_49 * v_545);
        const float per_t_56 = 1.0f / t_56;
        const float gain_50 = v_529 * per_t_56;
        const float v_547 = (v_520 * v_546) - v_487;
        const float v_548 = v_546 - (gain_50 * v_547);
        const float per_t_57 = 1.0f / t_57;
        const float kept_48 = t_56 * per_t_57;
        after->factors[2] = v_548 * kept_48;
        const float v_549 = (u_1_2 * v_505) - v_488;
        const float v_550 = u_1_2 - (gain_42 * v_549);
        const float v_551 = (v_507 * v_550) - v_490;
        const float v_552 = v_550 - (gain_43 * v_551);
        const float v_553 = (v_509 * v_552) - v_492;
        const float v_554 = v_552 - (gain_44 * v_553);
        const float v_555 = (v_511 * v_554) - v_494;
        const float v_556 = v_554 - (gain_45 * v_555);
        const float v_557 = (v_513 * v_556) - v_496;
        const float v_558 = v_556 - (gain_46 * v_557);
        const float v_559 = (v_515 * v_558) - v_498;
        const float v_560 = v_558 - (gain_47 * v_559);
        const float v_561 = (v_517 * v_560) - v_500;
        const float v_562 = v_560 - (gain_48 * v_561);
        const float v_563 = (v_519 * v_562) - v_502;
        const float v_564 = v_562 - (gain_49 * v_563);
        const float v_565 = (v_520 * v_564) - v_503;
        const float v_566 = v_564 - (gain_50 * v_565);
        after->factors[13] = v_566 * kept_48;
        const float q_1_1 = params->variance_step_vx;
        const float d_1 = before->factors[12];
        const float kept_49 = d_2 * per_t_48;
        const float w_48 = w_39 * kept_49;
        const float v_567 = w_48 * v_549;
        const float t_58 = d_1 + (v_549 * v_567);
        const float kept_50 = t_48 * per_t_49;
        const float w_49 = w_40 * kept_50;
        const float v_568 = w_49 * v_551;
        const float t_59 = t_58 + (v_551 * v_568);
        const float kept_51 = t_49 * per_t_50;
        const float w_50 = w_41 * kept_51;
        const float v_569 = w_50 * v_553;
        const float t_60 = t_59 + (v_553 * v_569);
        const float kept_52 = t_50 * per_t_51;
        const float w_51 = w_42 * kept_52;
        const float v_570 = w_51 * v_555;
        const float t_61 = t_60 + (v_555 * v_570);
        const float kept_53 = t_51 * per_t_52;
        const float w_52 = w_43 * kept_53;
        const float v_571 = w_52 * v_557;
        const float t_62 = t_61 + (v_557 * v_571);
        const float kept_54 = t_52 * per_t_53;
        const float w_53 = w_44 * kept_54;
        const float v_572 = w_53 * v_559;
        const float t_63 = t_62 + (v_559 * v_572);
        const float kept_55 = t_53 * per_t_54;
        const float w_54 = w_45 * kept_55;
        const float v_573 = w_54 * v_561;
        const float t_64 = t_63 + (v_561 * v_573);
        const float kept_56 = t_54 * per_t_55;
        const float w_55 = w_46 * kept_56;
        const float v_574 = w_55 * v_563;
        const float t_65 = t_64 + (v_563 * v_574);
        const float kept_57 = t_55 * per_t_56;
        const float w_56 = w_47 * kept_57;
        const float v_575 = w_56 * v_565;
        const float t_66 = t_65 + (v_565 * v_575);
        const float w_57 = q_2_2 * kept_48;
        const float v_576 = v_566 * w_57;
        const float t_67 = t_66 + (v_566 * v_576);
        const float t_68 = q_1_1 + t_67;
        after->factors[12] = t_68;
        const float v_577 = 0.025f + before->factors[1];
        const float per_t_58 = 1.0f / t_58;
        const float gain_51 = v_567 * per_t_58;
        const float v_578 = (v_577 * v_549) - v_531;
        const float v_579 = v_577 - (gain_51 * v_578);
        const float per_t_59 = 1.0f / t_59;
        const float gain_52 = v_568 * per_t_59;
        const float v_580 = (v_551 * v_579) - v_533;
        const float v_581 = v_579 - (gain_52 * v_580);
        const float per_t_60 = 1.0f / t_60;
        const float gain_53 = v_569 * per_t_60;
        const float v_582 = (v_553 * v_581) - v_535;
        const float v_583 = v_581 - (gain_53 * v_582);
        const float per_t_61 = 1.0f / t_61;
        const float gain_54 = v_570 * per_t_61;
        const float v_584 = (v_555 * v_583) - v_537;
        const float v_585 = v_583 - (gain_54 * v_584);
        const float per_t_62 = 1.0f / t_62;
        const float gain_55 = v_571 * per_t_62;
        const float v_586 = (v_557 * v_585) - v_539;
        const float v_587 = v_585 - (gain_55 * v_586);
        const float per_t_63 = 1.0f / t_63;
        const float gain_56 = v_572 * per_t_63;
        const float v_588 = (v_559 * v_587) - v_541;
        const float v_589 = v_587 - (gain_56 * v_588);
        const float per_t_64 = 1.0f / t_64;
        const float gain_57 = v_573 * per_t_64;
        const float v_590 = (v_561 * v_589) - v_543;
        const float v_591 = v_589 - (gain_57 * v_590);
        const float per_t_65 = 1.0f / t_65;
        const float gain_58 = v_574 * per_t_65;
        const float v_592 = (v_563 * v_591) - v_545;
        const float v_593 = v_591 - (gain_58 * v_592);
        const float per_t_66 = 1.0f / t_66;
        const float gain_59 = v_575 * per_t_66;
        const float v_594 = (v_565 * v_593) - v_547;
        const float v_595 = v_593 - (gain_59 * v_594);
        const float per_t_67 = 1.0f / t_67;
        const float gain_60 = v_576 * per_t_67;
        const float v_596 = (v_566 * v_595) - v_548;
        const float v_597 = v_595 - (gain_60 * v_596);
        const float per_t_68 = 1.0f / t_68;
        const float kept_58 = t_67 * per_t_68;
        after->factors[1] = v_597 * kept_58;
        const float kept_59 = d_1 * per_t_58;
        const float w_58 = w_48 * kept_59;
        const float t_69 = before->factors[0] + (v_578 * (w_58 * v_578));
        const float kept_60 = t_58 * per_t_59;
        const float w_59 = w_49 * kept_60;
        const float t_70 = t_69 + (v_580 * (w_59 * v_580));
        const float kept_61 = t_59 * per_t_60;
        const float w_60 = w_50 * kept_61;
        const float t_71 = t_70 + (v_582 * (w_60 * v_582));
        const float kept_62 = t_60 * per_t_61;
        const float w_61 = w_51 * kept_62;
        const float t_72 = t_71 + (v_584 * (w_61 * v_584));
        const float kept_63 = t_61 * per_t_62;
        const float w_62 = w_52 * kept_63;
        const float t_73 = t_72 + (v_586 * (w_62 * v_586));
        const float kept_64 = t_62 * per_t_63;
        const float w_63 = w_53 * kept_64;
        const float t_74 = t_73 + (v_588 * (w_63 * v_588));
        const float kept_65 = t_63 * per_t_64;
        const float w_64 = w_54 * kept_65;
        const float t_75 = t_74 + (v_590 * (w_64 * v_590));
        const float kept_66 = t_64 * per_t_65;
        const float w_65 = w_55 * kept_66;
        const float t_76 = t_75 + (v_592 * (w_65 * v_592));
        const float kept_67 = t_65 * per_t_66;
        const float w_66 = w_56 * kept_67;
        const float t_77 = t_76 + (v_594 * (w_66 * v_594));
        const float kept_68 = t_66 * per_t_67;
        const float w_67 = w_57 * kept_68;
        const float t_78 = t_77 + (v_596 * (w_67 * v_596));
        const float w_68 = q_1_1 * kept_58;
        const float t_79 = t_78 + (v_597 * (v_597 * w_68));
        after->factors[0] = params->variance_step_x + t_79;
    }

    if (!(((params->variance_step_x >= 0.0f) == true) && ((params->variance_step_vx >= 0.0f) == true)
          && ((params->variance_step_y >= 0.0f) == true) && ((params->variance_step_vy >= 0.0f) == true)
          && ((params->variance_step_z >= 0.0f) == true) && ((params->variance_step_vz >= 0.0f) == true)
          && ((params->variance_step_roll >= 0.0f) == true) && ((params->variance_step_roll_rate >= 0.0f) == true)
          && ((params->variance_step_pitch >= 0.0f) == true) && ((params->variance_step_pitch_rate >= 0.0f) == true)
          && ((params->variance_step_yaw >= 0.0f) == true) && ((params->variance_step_yaw_rate >= 0.0f) == true)))
    {
        status = QUADROTOR_UD_NOT_POSITIVE;
    }
    else
    {
        /* judge, then commit */
        if (!quadrotor_ud_is_bounded(after->factors))
        {
            status = quadrotor_ud_hold_factors(after->factors);
        }
        if (status >= QUADROTOR_UD_OK)
        {
            if (!(((after->x >= -10000.0f) == true) && ((after->x <= 10000.0f) == true)
                  && ((after->vx >= -1000.0f) == true) && ((after->vx <= 1000.0f) == true)
                  && ((after->y >= -10000.0f) == true) && ((after->y <= 10000.0f) == true)
                  && ((after->vy >= -1000.0f) == true) && ((after->vy <= 1000.0f) == true)
                  && ((after->z >= -10000.0f) == true) && ((after->z <= 10000.0f) == true)
                  && ((after->vz >= -1000.0f) == true) && ((after->vz <= 1000.0f) == true)
                  && ((after->roll >= -30.0f) == true) && ((after->roll <= 30.0f) == true)
                  && ((after->roll_rate >= -100.0f) == true) && ((after->roll_rate <= 100.0f) == true)
                  && ((after->pitch >= -30.0f) == true) && ((after->pitch <= 30.0f) == true)
                  && ((after->pitch_rate >= -100.0f) == true) && ((after->pitch_rate <= 100.0f) == true)
                  && ((after->yaw >= -30.0f) == true) && ((after->yaw <= 30.0f) == true)
                  && ((after->yaw_rate >= -100.0f) == true) && ((after->yaw_rate <= 100.0f) == true)))
            {
                status = QUADROTOR_UD_OVERFLOW;
            }
        }
    }
    return status;
}

static quadrotor_ud_status_t quadrotor_ud_predict_core(const quadrotor_ud_state_t *before, quadrotor_ud_state_t *after,
                                                       const quadrotor_ud_params_t *params, const float rotor_1,
                                                       const float rotor_2, const float rotor_3, const float rotor_4)
{
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;

    if (!(((rotor_1 >= -1000.0f) == true) && ((rotor_1 <= 1000.0f) == true) && ((rotor_2 >= -1000.0f) == true)
          && ((rotor_2 <= 1000.0f) == true) && ((rotor_3 >= -1000.0f) == true) && ((rotor_3 <= 1000.0f) == true)
          && ((rotor_4 >= -1000.0f) == true) && ((rotor_4 <= 1000.0f) == true)))
    {
        status = QUADROTOR_UD_BAD_INPUT;
    }
    else
    {
        status = quadrotor_ud_predict_judged(before, after, params, rotor_1, rotor_2, rotor_3, rotor_4);
    }
    return status;
}

/* 678 additions, 884 multiplications, 42 divisions, 6 selections. */
static quadrotor_ud_status_t quadrotor_ud_update_pose_judged(const quadrotor_ud_state_t *before,
                                                             quadrotor_ud_state_t *after,
                                                             const quadrotor_ud_params_t *params, const float pose[6],
                                                             const float gate, quadrotor_ud_update_pose_out_t *out)
{
    float delta[12];
    float nis[1];
    float row_variance[6];
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;

    /* residual[0] = pose[0] - x */
    /* residual[1] = pose[1] - y */
    /* residual[2] = pose[2] - z */
    /* residual[3] = pose[3] - roll */
    /* residual[4] = pose[4] - pitch */
    /* residual[5] = pose[5] - yaw */
    const float residual_0 = pose[0] - before->x;
    const float residual_1 = pose[1] - before->y;
    const float residual_2 = pose[2] - before->z;
    const float residual_3 = pose[3] - before->roll;
    const float residual_4 = pose[4] - before->pitch;
    const float residual_5 = pose[5] - before->yaw;

    /* variance of the innovation: diagonal of H U D U' H' + R */
    {
        const float u_0_11 = before->factors[11];
        const float d_11 = before->factors[77];
        const float u_0_10 = before->factors[10];
        const float d_10 = before->factors[75];
        const float u_0_9 = before->factors[9];
        const float d_9 = before->factors[72];
        const float u_0_8 = before->factors[8];
        const float d_8 = before->factors[68];
        const float u_0_7 = before->factors[7];
        const float d_7 = before->factors[63];
        const float u_0_6 = before->factors[6];
        const float d_6 = before->factors[57];
        const float u_0_5 = before->factors[5];
        const float d_5 = before->factors[50];
        const float u_0_4 = before->factors[4];
        const float d_4 = before->factors[42];
        const float u_0_3 = before->factors[3];
        const float d_3 = before->factors[33];
        const float u_0_2 = before->factors[2];
        const float d_2 = before->factors[23];
        const float u_0_1 = before->factors[1];
        const float v = (u_0_2 * (u_0_2 * d_2)) + (before->factors[0] + (u_0_1 * (u_0_1 * before->factors[12])));
        const float v_2 = (u_0_6 * (u_0_6 * d_6)) + ((u_0_5 * (u_0_5 * d_5)) + ((u_0_4 * (u_0_4 * d_4)) + ((u_0_3 *
            (u_0_3 * d_3)) + v)));
        const float v_3 = (u_0_9 * (u_0_9 * d_9)) + ((u_0_8 * (u_0_8 * d_8)) + ((u_0_7 * (u_0_7 * d_7)) + v_2));
        out->variance[0] = params->variance_pose[0] + ((u_0_11 * (u_0_11 * d_11)) + ((u_0_10 * (u_0_10 * d_10)) + v_3));
        const float u_2_11 = before->factors[32];
        const float u_2_10 = before->factors[31];
        const float u_2_9 = before->factors[30];
        const float u_2_8 = before->factors[29];
        const float u_2_7 = before->factors[28];
        const float u_2_6 = before->factors[27];
        const float u_2_5 = before->factors[26];
        const float u_2_4 = before->factors[25];
        const float u_2_3 = before->factors[24];
        const float v_4 = (u_2_5 * (u_2_5 * d_5)) + ((u_2_4 * (u_2_4 * d_4)) + (d_2 + (u_2_3 * (u_2_3 * d_3))));
        const float v_5 = (u_2_8 * (u_2_8 * d_8)) + ((u_2_7 * (u_2_7 * d_7)) + ((u_2_6 * (u_2_6 * d_6)) + v_4));
        const float v_6 = (u_2_11 * (u_2_11 * d_11)) + ((u_2_10 * (u_2_10 * d_10)) + ((u_2_9 * (u_2_9 * d_9)) + v_5));
        out->variance[1] = params->variance_pose[1] + v_6;
        const float u_4_11 = before->factors[49];
        const float u_4_10 = before->factors[48];
        const float u_4_9 = before->factors[47];
        const float u_4_8 = before->factors[46];
        const float u_4_7 = before->factors[45];
        const float u_4_6 = before->factors[44];
        const float u_4_5 = before->factors[43];
        const float v_7 = (u_4_7 * (u_4_7 * d_7)) + ((u_4_6 * (u_4_6 * d_6)) + (d_4 + (u_4_5 * (u_4_5 * d_5))));
        const float v_8 = (u_4_10 * (u_4_10 * d_10)) + ((u_4_9 * (u_4_9 * d_9)) + ((u_4_8 * (u_4_8 * d_8)) + v_7));
        out->variance[2] = params->variance_pose[2] + ((u_4_11 * (u_4_11 * d_11)) + v_8);
        const float u_6_11 = before->factors[62];
        const float u_6_10 = before->factors[61];
        const float u_6_9 = before->factors[60];
        const float u_6_8 = before->factors[59];
        const float u_6_7 = before->factors[58];
        const float v_9 = (u_6_9 * (u_6_9 * d_9)) + ((u_6_8 * (u_6_8 * d_8)) + (d_6 + (u_6_7 * (u_6_7 * d_7))));
        out->variance[3] = params->variance_pose[3] + ((u_6_11 * (u_6_11 * d_11)) + ((u_6_10 * (u_6_10 * d_10)) + v_9));
        const float u_8_11 = before->factors[71];
        const float u_8_10 = before->factors[70];
        const float u_8_9 = before->factors[69];
        const float v_10 = (u_8_11 * (u_8_11 * d_11)) + ((u_8_10 * (u_8_10 * d_10)) + (d_8 + (u_8_9 * (u_8_9 * d_9))));
        out->variance[4] = params->variance_pose[4] + v_10;
        const float u_10_11 = before->factors[76];
        out->variance[5] = params->variance_pose[5] + (d_10 + (u_10_11 * (u_10_11 * d_11)));
    }
    out->innovation[0] = residual_0;
    out->innovation[1] = residual_1;
    out->innovation[2] = residual_2;
    out->innovation[3] = residual_3;
    out->innovation[4] = residual_4;
    out->innovation[5] = residual_5;

    /* row 0: d = d + K e, Bierman's update of U and D */
    /* row 1: d = d + K e, Bierman's update of U and D */
    /* row 2: d = d + K e, Bierman's update of U and D */
    /* row 3: d = d + K e, Bierman's update of U and D */
    {
        const float d_0 = before->factors[0];
        const float r_0 = params->variance_pose[0];
        const float v = r_0 + d_0;
        const float per_a_0 = 1.0f / ((v >= 1.0e-20f) ? v : 1.0f);
        after->factors[0] = d_0 * (r_0 * per_a_0);
        const float u_0_1 = before->factors[1];
        const float loss_1 = u_0_1 * per_a_0;
        after->factors[1] = r_0 * loss_1;
        const float u_0_2 = before->factors[2];
        const float d_1 = before->factors[12];
        const float v_2 = u_0_1 * d_1;
        const float v_3 = u_0_1 * v_2;
        const float v_4 = v_3 + v;
        const float per_a_1 = 1.0f / v_4;
        const float loss_2 = u_0_2 * per_a_1;
        const float v_5 = r_0 * loss_2;
        after->factors[2] = v_5;
        const float u_0_3 = before->factors[3];
        const float d_2 = before->factors[23];
        const float v_6 = u_0_2 * d_2;
        const float v_7 = u_0_2 * v_6;
        const float v_8 = v_7 + v_4;
        const float per_a_2 = 1.0f / v_8;
        const float loss_3 = u_0_3 * per_a_2;
        const float v_9 = r_0 * loss_3;
        const float new_d_2 = d_2 * (v_4 * per_a_2);
        const float v_10 = new_d_2 * v_5;
        const float u_2_3 = before->factors[24];
        const float v_11 = u_2_3 - (v_6 * loss_3);
        const float r_1 = params->variance_pose[1];
        const float v_12 = r_1 + new_d_2;
        const float per_a_2_2 = 1.0f / ((v_12 >= 1.0e-20f) ? v_12 : 1.0f);
        const float loss_3_2 = v_11 * per_a_2_2;
        after->factors[3] = v_9 - (v_10 * loss_3_2);
        const float u_0_4 = before->factors[4];
        const float d_3 = before->factors[33];
        const float v_13 = u_0_3 * d_3;
        const float v_14 = u_0_3 * v_13;
        const float v_15 = v_14 + v_8;
        const float per_a_3 = 1.0f / v_15;
        const float loss_4 = u_0_4 * per_a_3;
        const float v_16 = r_0 * loss_4;
        const float new_d_3 = d_3 * (v_8 * per_a_3);
        const float v_17 = new_d_3 * v_11;
        const float v_18 = v_10 + (v_9 * v_17);
        const float u_2_4 = before->factors[25];
        const float v_19 = v_6 + (u_2_3 * v_13);
        const float v_20 = u_2_4 - (v_19 * loss_4);
        const float v_21 = v_11 * v_17;
        const float v_22 = v_12 + v_21;
        const float per_a_3_2 = 1.0f / v_22;
        const float loss_4_2 = v_20 * per_a_3_2;
        const float v_23 = v_16 - (v_18 * loss_4_2);
        after->factors[4] = v_23;
        const float u_0_5 = before->factors[5];
        const float d_4 = before->factors[42];
        const float v_24 = u_0_4 * d_4;
        const float v_25 = u_0_4 * v_24;
        const float v_26 = v_25 + v_15;
        const float per_a_4 = 1.0f / v_26;
        const float loss_5 = u_0_5 * per_a_4;
        const float v_27 = r_0 * loss_5;
        const float new_d_4 = d_4 * (v_15 * per_a_4);
        const float v_28 = new_d_4 * v_20;
        const float v_29 = v_18 + (v_16 * v_28);
        const float u_2_5 = before->factors[26];
        const float v_30 = v_19 + (u_2_4 * v_24);
        const float v_31 = u_2_5 - (v_30 * loss_5);
        const float v_32 = v_20 * v_28;
        const float v_33 = v_22 + v_32;
        const float per_a_4_2 = 1.0f / v_33;
        const float loss_5_2 = v_31 * per_a_4_2;
        const float v_34 = v_27 - (v_29 * loss_5_2);
        const float new_d_4_2 = new_d_4 * (v_22 * per_a_4_2);
        const float v_35 = new_d_4_2 * v_23;
        const float u_4_5 = before->factors[43];
        const float v_36 = u_4_5 - (v_24 * loss_5);
        const float v_37 = v_36 - (v_28 * loss_5_2);
        const float r_2 = params->variance_pose[2];
        const float v_38 = r_2 + new_d_4_2;
        const float per_a_4_3 = 1.0f / ((v_38 >= 1.0e-20f) ? v_38 : 1.0f);
        const float loss_5_3 = v_37 * per_a_4_3;
        after->factors[5] = v_34 - (v_35 * loss_5_3);
        const float u_0_6 = before->factors[6];
        const float d_5 = before->factors[50];
        const float v_39 = u_0_5 * d_5;
        const float v_40 = u_0_5 * v_39;
        const float v_41 = v_40 + v_26;
        const float per_a_5 = 1.0f / v_41;
        const float loss_6 = u_0_6 * per_a_5;
        const float v_42 = r_0 * loss_6;
        const float new_d_5 = d_5 * (v_26 * per_a_5);
        const float v_43 = new_d_5 * v_31;
        const float v_44 = v_29 + (v_27 * v_43);
        const float u_2_6 = before->factors[27];
        const float v_45 = v_30 + (u_2_5 * v_39);
        const float v_46 = u_2_6 - (v_45 * loss_6);
        const float v_47 = v_31 * v_43;
        const float v_48 = v_33 + v_47;
        const float per_a_5_2 = 1.0f / v_48;
        const float loss_6_2 = v_46 * per_a_5_2;
        const float v_49 = v_42 - (v_44 * loss_6_2);
        const float new_d_5_2 = new_d_5 * (v_33 * per_a_5_2);
        const float v_50 = new_d_5_2 * v_37;
        const float v_51 = v_35 + (v_34 * v_50);
        const float u_4_6 = before->factors[44];
        const float v_52 = v_24 + (u_4_5 * v_39);
        const float v_53 = u_4_6 - (v_52 * loss_6);
        const float v_54 = v_28 + (v_36 * v_43);
        const float v_55 = v_53 - (v_54 * loss_6_2);
        const float v_56 = v_37 * v_50;
        const float v_57 = v_38 + v_56;
        const float per_a_5_3 = 1.0f / v_57;
        const float loss_6_3 = v_55 * per_a_5_3;
        const float v_58 = v_49 - (v_51 * loss_6_3);
        after->factors[6] = v_58;
        const float u_0_7 = before->factors[7];
        const float d_6 = before->factors[57];
        const float v_59 = u_0_6 * d_6;
        const float v_60 = u_0_6 * v_59;
        const float v_61 = v_60 + v_41;
        const float per_a_6 = 1.0f / v_61;
        const float loss_7 = u_0_7 * per_a_6;
        const float v_62 = r_0 * loss_7;
        const float new_d_6 = d_6 * (v_41 * per_a_6);
        const float v_63 = new_d_6 * v_46;
        const float v_64 = v_44 + (v_42 * v_63);
        const float u_2_7 = before->factors[28];
        const float v_65 = v_45 + (u_2_6 * v_59);
        const float v_66 = u_2_7 - (v_65 * loss_7);
        const float v_67 = v_46 * v_63;
        const float v_68 = v_48 + v_67;
        const float per_a_6_2 = 1.0f / v_68;
        const float loss_7_2 = v_66 * per_a_6_2;
        const float v_69 = v_62 - (v_64 * loss_7_2);
        const float new_d_6_2 = new_d_6 * (v_48 * per_a_6_2);
        const float v_70 = new_d_6_2 * v_55;
        const float v_71 = v_51 + (v_49 * v_70);
        const float u_4_7 = before->factors[45];
        const float v_72 = v_52 + (u_4_6 * v_59);
        const float v_73 = u_4_7 - (v_72 * loss_7);
        const float v_74 = v_54 + (v_53 * v_63);
        const float v_75 = v_73 - (v_74 * loss_7_2);
        const float v_76 = v_55 * v_70;
        const float v_77 = v_57 + v_76;
        const float per_a_6_3 = 1.0f / v_77;
        const float loss_7_3 = v_75 * per_a_6_3;
        const float v_78 = v_69 - (v_71 * loss_7_3);
        const float new_d_6_3 = new_d_6_2 * (v_57 * per_a_6_3);
        const float v_79 = new_d_6_3 * v_58;
        const float u_6_7 = before->factors[58];
        const float v_80 = u_6_7 - (v_59 * loss_7);
        const float v_81 = v_80 - (v_63 * loss_7_2);
        const float v_82 = v_81 - (v_70 * loss_7_3);
        const float r_3 = params->variance_pose[3];
        const float v_83 = r_3 + new_d_6_3;
        const float per_a_6_4 = 1.0f / ((v_83 >= 1.0e-20f) ? v_83 : 1.0f);
        const float loss_7_4 = v_82 * per_a_6_4;
        after->factors[7] = v_78 - (v_79 * loss_7_4);
        const float u_0_8 = before->factors[8];
        const float d_7 = before->factors[63];
        const float v_84 = u_0_7 * d_7;
        const float v_85 = u_0_7 * v_84;
        const float v_86 = v_85 + v_61;
        const float per_a_7 = 1.0f / v_86;
        const float loss_8 = u_0_8 * per_a_7;
        const float v_87 = r_0 * loss_8;
        const float new_d_7 = d_7 * (v_61 * per_a_7);
        const float v_88 = new_d_7 * v_66;
        const float v_89 = v_64 + (v_62 * v_88);
        const float u_2_8 = before->factors[29];
        const float v_90 = v_65 + (u_2_7 * v_84);
        const float v_91 = u_2_8 - (v_90 * loss_8);
        const float v_92 = v_66 * v_88;
        const float v_93 = v_68 + v_92;
        const float per_a_7_2 = 1.0f / v_93;
        const float loss_8_2 = v_91 * per_a_7_2;
        const float v_94 = v_87 - (v_89 * loss_8_2);
        const float new_d_7_2 = new_d_7 * (v_68 * per_a_7_2);
        const float v_95 = new_d_7_2 * v_75;
        const float v_96 = v_71 + (v_69 * v_95);
        const float u_4_8 = before->factors[46];
        const float v_97 = v_72 + (u_4_7 * v_84);
        const float v_98 = u_4_8 - (v_97 * loss_8);
        const float v_99 = v_74 + (v_73 * v_88);
        const float v_100 = v_98 - (v_99 * loss_8_2);
        const float v_101 = v_75 * v_95;
        const float v_102 = v_77 + v_101;
        const float per_a_7_3 = 1.0f / v_102;
        const float loss_8_3 = v_100 * per_a_7_3;
        const float v_103 = v_94 - (v_96 * loss_8_3);
        const float new_d_7_3 = new_d_7_2 * (v_77 * per_a_7_3);
        const float v_104 = new_d_7_3 * v_82;
        const float v_105 = v_79 + (v_78 * v_104);
        const float u_6_8 = before->factors[59];
        const float v_106 = v_59 + (u_6_7 * v_84);
        const float v_107 = u_6_8 - (v_106 * loss_8);
        const float v_108 = v_63 + (v_80 * v_88);
        const float v_109 = v_107 - (v_108 * loss_8_2);
        const float v_110 = v_70 + (v_81 * v_95);
        const float v_111 = v_109 - (v_110 * loss_8_3);
        const float v_112 = v_82 * v_104;
        const float v_113 = v_83 + v_112;
        const float per_a_7_4 = 1.0f / v_113;
        const float loss_8_4 = v_111 * per_a_7_4;
        after->factors[8] = v_103 - (v_105 * loss_8_4);
        const float u_0_9 = before->factors[9];
        const float d_8 = before->factors[68];
        const float v_114 = u_0_8 * d_8;
        const float v_115 = u_0_8 * v_114;
        const float v_116 = v_115 + v_86;
        const float per_a_8 = 1.0f / v_116;
        const float loss_9 = u_0_9 * per_a_8;
        const float v_117 = r_0 * loss_9;
        const float new_d_8 = d_8 * (v_86 * per_a_8);
        const float v_118 = new_d_8 * v_91;
        const float v_119 = v_89 + (v_87 * v_118);
        const float u_2_9 = before->factors[30];
        const float v_120 = v_90 + (u_2_8 * v_114);
        const float v_121 = u_2_9 - (v_120 * loss_9);
        const float v_122 = v_91 * v_118;
        const float v_123 = v_93 + v_122;
        const float per_a_8_2 = 1.0f / v_123;
        const float loss_9_2 = v_121 * per_a_8_2;
        const float v_124 = v_117 - (v_119 * loss_9_2);
        const float new_d_8_2 = new_d_8 * (v_93 * per_a_8_2);
        const float v_125 = new_d_8_2 * v_100;
        const float v_126 = v_96 + (v_94 * v_125);
        const float u_4_9 = before->factors[47];
        const float v_127 = v_97 + (u_4_8 * v_114);
        const float v_128 = u_4_9 - (v_127 * loss_9);
        const float v_129 = v_99 + (v_98 * v_118);
        const float v_130 = v_128 - (v_129 * loss_9_2);
        const float v_131 = v_100 * v_125;
        const float v_132 = v_102 + v_131;
        const float per_a_8_3 = 1.0f / v_132;
        const float loss_9_3 = v_130 * per_a_8_3;
        const float v_133 = v_124 - (v_126 * loss_9_3);
        const float new_d_8_3 = new_d_8_2 * (v_102 * per_a_8_3);
        const float v_134 = new_d_8_3 * v_111;
        const float v_135 = v_105 + (v_103 * v_134);
        const float u_6_9 = before->factors[60];
        const float v_136 = v_106 + (u_6_8 * v_114);
        const float v_137 = u_6_9 - (v_136 * loss_9);
        const float v_138 = v_108 + (v_107 * v_118);
        const float v_139 = v_137 - (v_138 * loss_9_2);
        const float v_140 = v_110 + (v_109 * v_125);
        const float v_141 = v_139 - (v_140 * loss_9_3);
        const float v_142 = v_111 * v_134;
        const float v_143 = v_113 + v_142;
        const float per_a_8_4 = 1.0f / v_143;
        const float loss_9_4 = v_141 * per_a_8_4;
        after->factors[9] = v_133 - (v_135 * loss_9_4);
        const float u_0_10 = before->factors[10];
        const float d_9 = before->factors[72];
        const float v_144 = u_0_9 * d_9;
        const float v_145 = u_0_9 * v_144;
        const float v_146 = v_145 + v_116;
        const float per_a_9 = 1.0f / v_146;
        const float loss_10 = u_0_10 * per_a_9;
        const float v_147 = r_0 * loss_10;
        const float new_d_9 = d_9 * (v_116 * per_a_9);
        const float v_148 = new_d_9 * v_121;
        const float v_149 = v_119 + (v_117 * v_148);
        const float u_2_10 = before->factors[31];
        const float v_150 = v_120 + (u_2_9 * v_144);
        const float v_151 = u_2_10 - (v_150 * loss_10);
        const float v_152 = v_121 * v_148;
        const float v_153 = v_123 + v_152;
        const float per_a_9_2 = 1.0f / v_153;
        const float loss_10_2 = v_151 * per_a_9_2;
        const float v_154 = v_147 - (v_149 * loss_10_2);
        const float new_d_9_2 = new_d_9 * (v_123 * per_a_9_2);
        const float v_155 = new_d_9_2 * v_130;
        const float v_156 = v_126 + (v_124 * v_155);
        const float u_4_10 = before->factors[48];
        const float v_157 = v_127 + (u_4_9 * v_144);
        const float v_158 = u_4_10 - (v_157 * loss_10);
        const float v_159 = v_129 + (v_128 * v_148);
        const float v_160 = v_158 - (v_159 * loss_10_2);
        const float v_161 = v_130 * v_155;
        const float v_162 = v_132 + v_161;
        const float per_a_9_3 = 1.0f / v_162;
        const float loss_10_3 = v_160 * per_a_9_3;
        const float v_163 = v_154 - (v_156 * loss_10_3);
        const float new_d_9_3 = new_d_9_2 * (v_132 * per_a_9_3);
        const float v_164 = new_d_9_3 * v_141;
        const float v_165 = v_135 + (v_133 * v_164);
        const float u_6_10 = before->factors[61];
        const float v_166 = v_136 + (u_6_9 * v_144);
        const float v_167 = u_6_10 - (v_166 * loss_10);
        const float v_168 = v_138 + (v_137 * v_148);
        const float v_169 = v_167 - (v_168 * loss_10_2);
        const float v_170 = v_140 + (v_139 * v_155);
        const float v_171 = v_169 - (v_170 * loss_10_3);
        const float v_172 = v_141 * v_164;
        const float v_173 = v_143 + v_172;
        const float per_a_9_4 = 1.0f / v_173;
        const float loss_10_4 = v_171 * per_a_9_4;
        after->factors[10] = v_163 - (v_165 * loss_10_4);
        const float u_0_11 = before->factors[11];
        const float d_10 = before->factors[75];
        const float v_174 = u_0_10 * d_10;
        const float v_175 = u_0_10 * v_174;
        const float v_176 = v_175 + v_146;
        const float per_a_10 = 1.0f / v_176;
        const float loss_11 = u_0_11 * per_a_10;
        const float v_177 = r_0 * loss_11;
        const float new_d_10 = d_10 * (v_146 * per_a_10);
        const float v_178 = new_d_10 * v_151;
        const float v_179 = v_149 + (v_147 * v_178);
        const float u_2_11 = before->factors[32];
        const float v_180 = v_150 + (u_2_10 * v_174);
        const float v_181 = u_2_11 - (v_180 * loss_11);
        const float v_182 = v_151 * v_178;
        const float v_183 = v_153 + v_182;
        const float per_a_10_2 = 1.0f / v_183;
        const float loss_11_2 = v_181 * per_a_10_2;
        const float v_184 = v_177 - (v_179 * loss_11_2);
        const float new_d_10_2 = new_d_10 * (v_153 * per_a_10_2);
        const float v_185 = new_d_10_2 * v_160;
        const float v_186 = v_156 + (v_154 * v_185);
        const float u_4_11 = before->factors[49];
        const float v_187 = v_157 + (u_4_10 * v_174);
        const float v_188 = u_4_11 - (v_187 * loss_11);
        const float v_189 = v_159 + (v_158 * v_178);
        const float v_190 = v_188 - (v_189 * loss_11_2);
        const float v_191 = v_160 * v_185;
        const float v_192 = v_162 + v_191;
        const float per_a_10_3 = 1.0f / v_192;
        const float loss_11_3 = v_190 * per_a_10_3;
        const float v_193 = v_184 - (v_186 * loss_11_3);
        const float new_d_10_3 = new_d_10_2 * (v_162 * per_a_10_3);
        const float v_194 = new_d_10_3 * v_171;
        const float v_195 = v_165 + (v_163 * v_194);
        const float u_6_11 = before->factors[62];
        const float v_196 = v_166 + (u_6_10 * v_174);
        const float v_197 = u_6_11 - (v_196 * loss_11);
        const float v_198 = v_168 + (v_167 * v_178);
        const float v_199 = v_197 - (v_198 * loss_11_2);
        const float v_200 = v_170 + (v_169 * v_185);
        const float v_201 = v_199 - (v_200 * loss_11_3);
        const float v_202 = v_171 * v_194;
        const float v_203 = v_173 + v_202;
        const float per_a_10_4 = 1.0f / v_203;
        const float loss_11_4 = v_201 * per_a_10_4;
        after->factors[11] = v_193 - (v_195 * loss_11_4);
        after->factors[12] = d_1 * (v * per_a_1);
        const float u_1_2 = before->factors[13];
        const float v_204 = u_1_2 - (v_2 * loss_2);
        after->factors[13] = v_204;
        const float u_1_3 = before->factors[14];
        const float v_205 = v_2 + (u_1_2 * v_6);
        const float v_206 = u_1_3 - (v_205 * loss_3);
        const float v_207 = new_d_2 * v_204;
        after->factors[14] = v_206 - (v_207 * loss_3_2);
        const float u_1_4 = before->factors[15];
        const float v_208 = v_205 + (u_1_3 * v_13);
        const float v_209 = u_1_4 - (v_208 * loss_4);
        const float v_210 = v_207 + (v_206 * v_17);
        const float v_211 = v_209 - (v_210 * loss_4_2);
        after->factors[15] = v_211;
        const float u_1_5 = before->factors[16];
        const float v_212 = v_208 + (u_1_4 * v_24);
        const float v_213 = u_1_5 - (v_212 * loss_5);
        const float v_214 = v_210 + (v_209 * v_28);
        const float v_215 = v_213 - (v_214 * loss_5_2);
        const float v_216 = new_d_4_2 * v_211;
        after->factors[16] = v_215 - (v_216 * loss_5_3);
        const float u_1_6 = before->factors[17];
        const float v_217 = v_212 + (u_1_5 * v_39);
        const float v_218 = u_1_6 - (v_217 * loss_6);
        const float v_219 = v_214 + (v_213 * v_43);
        const float v_220 = v_218 - (v_219 * loss_6_2);
        const float v_221 = v_216 + (v_215 * v_50);
        const float v_222 = v_220 - (v_221 * loss_6_3);
        after->factors[17] = v_222;
        const float u_1_7 = before->factors[18];
        const float v_223 = v_217 + (u_1_6 * v_59);
        const float v_224 = u_1_7 - (v_223 * loss_7);
        const float v_225 = v_219 + (v_218 * v_63);
        const float v_226 = v_224 - (v_225 * loss_7_2);
        const float v_227 = v_221 + (v_220 * v_70);
        const float v_228 = v_226 - (v_227 * loss_7_3);
        const float v_229 = new_d_6_3 * v_222;
        after->factors[18] = v_228 - (v_229 * loss_7_4);
        const float u_1_8 = before->factors[19];
        const float v_230 = v_223 + (u_1_7 * v_84);
        const float v_231 = u_1_8 - (v_230 * loss_8);
        const float v_232 = v_225 + (v_224 * v_88);
        const float v_233 = v_231 - (v_232 * loss_8_2);
        const float v_234 = v_227 + (v_226 * v_95);
        const float v_235 = v_233 - (v_234 * loss_8_3);
        const float v_236 = v_229 + (v_228 * v_104);
        after->factors[19] = v_235 - (v_236 * loss_8_4);
        const float u_1_9 = before->factors[20];
        const float v_237 = v_230 + (u_1_8 * v_114);
        const float v_238 = u_1_9 - (v_237 * loss_9);
        const float v_239 = v_232 + (v_231 * v_118);
        const float v_240 = v_238 - (v_239 * loss_9_2);
        const float v_241 = v_234 + (v_233 * v_125);
        const float v_242 = v_240 - (v_241 * loss_9_3);
        const float v_243 = v_236 + (v_235 * v_134);
        after->factors[20] = v_242 - (v_243 * loss_9_4);
        const float u_1_10 = before->factors[21];
        const float v_244 = v_237 + (u_1_9 * v_144);
        const float v_245 = u_1_10 - (v_244 * loss_10);
        const float v_246 = v_239 + (v_238 * v_148);
        const float v_247 = v_245 - (v_246 * loss_10_2);
        const float v_248 = v_241 + (v_240 * v_155);
        const float v_249 = v_247 - (v_248 * loss_10_3);
        const float v_250 = v_243 + (v_242 * v_164);
        after->factors[21] = v_249 - (v_250 * loss_10_4);
        const float u_1_11 = before->factors[22];
        const float v_251 = v_244 + (u_1_10 * v_174);
        const float v_252 = u_1_11 - (v_251 * loss_11);
        const float v_253 = v_246 + (v_245 * v_178);
        const float v_254 = v_252 - (v_253 * loss_11_2);
        const float v_255 = v_248 + (v_247 * v_185);
        const float v_256 = v_254 - (v_255 * loss_11_3);
        const float v_257 = v_250 + (v_249 * v_194);
        after->factors[22] = v_256 - (v_257 * loss_11_4);
        after->factors[23] = new_d_2 * (r_1 * per_a_2_2);
        after->factors[24] = r_1 * loss_3_2;
        const float v_258 = r_1 * loss_4_2;
        after->factors[25] = v_258;
        const float v_259 = r_1 * loss_5_2;
        const float v_260 = new_d_4_2 * v_258;
        after->factors[26] = v_259 - (v_260 * loss_5_3);
        const float v_261 = r_1 * loss_6_2;
        const float v_262 = v_260 + (v_259 * v_50);
        const float v_263 = v_261 - (v_262 * loss_6_3);
        after->factors[27] = v_263;
        const float v_264 = r_1 * loss_7_2;
        const float v_265 = v_262 + (v_261 * v_70);
        const float v_266 = v_264 - (v_265 * loss_7_3);
        const float v_267 = new_d_6_3 * v_263;
        after->factors[28] = v_266 - (v_267 * loss_7_4);
        const float v_268 = r_1 * loss_8_2;
        const float v_269 = v_265 + (v_264 * v_95);
        const float v_270 = v_268 - (v_269 * loss_8_3);
        const float v_271 = v_267 + (v_266 * v_104);
        after->factors[29] = v_270 - (v_271 * loss_8_4);
        const float v_272 = r_1 * loss_9_2;
        const float v_273 = v_269 + (v_268 * v_125);
        const float v_274 = v_272 - (v_273 * loss_9_3);
        const float v_275 = v_271 + (v_270 * v_134);
        after->factors[30] = v_274 - (v_275 * loss_9_4);
        const float v_276 = r_1 * loss_10_2;
        const float v_277 = v_273 + (v_272 * v_155);
        const float v_278 = v_276 - (v_277 * loss_10_3);
        const float v_279 = v_275 + (v_274 * v_164);
        after->factors[31] = v_278 - (v_279 * loss_10_4);
        const float v_280 = r_1 * loss_11_2;
        const float v_281 = v_277 + (v_276 * v_185);
        const float v_282 = v_280 - (v_281 * loss_11_3);
        const float v_283 = v_279 + (v_278 * v_194);
        after->factors[32] = v_282 - (v_283 * loss_11_4);
        after->factors[33] = new_d_3 * (v_12 * per_a_3_2);
        const float u_3_4 = before->factors[34];
        const float v_284 = u_3_4 - (v_13 * loss_4);
        const float v_285 = v_284 - (v_17 * loss_4_2);
        after->factors[34] = v_285;
        const float u_3_5 = before->factors[35];
        const float v_286 = v_13 + (u_3_4 * v_24);
        const float v_287 = u_3_5 - (v_286 * loss_5);
        const float v_288 = v_17 + (v_284 * v_28);
        const float v_289 = v_287 - (v_288 * loss_5_2);
        const float v_290 = new_d_4_2 * v_285;
        after->factors[35] = v_289 - (v_290 * loss_5_3);
        const float u_3_6 = before->factors[36];
        const float v_291 = v_286 + (u_3_5 * v_39);
        const float v_292 = u_3_6 - (v_291 * loss_6);
        const float v_293 = v_288 + (v_287 * v_43);
        const float v_294 = v_292 - (v_293 * loss_6_2);
        const float v_295 = v_290 + (v_289 * v_50);
        const float v_296 = v_294 - (v_295 * loss_6_3);
        after->factors[36] = v_296;
        const float u_3_7 = before->factors[37];
        const float v_297 = v_291 + (u_3_6 * v_59);
        const float v_298 = u_3_7 - (v_297 * loss_7);
        const float v_299 = v_293 + (v_292 * v_63);
        const float v_300 = v_298 - (v_299 * loss_7_2);
        const float v_301 = v_295 + (v_294 * v_70);
        const float v_302 = v_300 - (v_301 * loss_7_3);
        const float v_303 = new_d_6_3 * v_296;
        after->factors[37] = v_302 - (v_303 * loss_7_4);
        const float u_3_8 = before->factors[38];
        const float v_304 = v_297 + (u_3_7 * v_84);
        const float v_305 = u_3_8 - (v_304 * loss_8);
        const float v_306 = v_299 + (v_298 * v_88);
        const float v_307 = v_305 - (v_306 * loss_8_2);
        const float v_308 = v_301 + (v_300 * v_95);
        const float v_309 = v_307 - (v_308 * loss_8_3);
        const float v_310 = v_303 + (v_302 * v_104);
        after->factors[38] = v_309 - (v_310 * loss_8_4);
        const float u_3_9 = before->factors[39];
        const float v_311 = v_304 + (u_3_8 * v_114);
        const float v_312 = u_3_9 - (v_311 * loss_9);
        const float v_313 = v_306 + (v_305 * v_118);
        const float v_314 = v_312 - (v_313 * loss_9_2);
        const float v_315 = v_308 + (v_307 * v_125);
        const float v_316 = v_314 - (v_315 * loss_9_3);
        const float v_317 = v_310 + (v_309 * v_134);
        after->factors[39] = v_316 - (v_317 * loss_9_4);
        const float u_3_10 = before->factors[40];
        const float v_318 = v_311 + (u_3_9 * v_144);
        const float v_319 = u_3_10 - (v_318 * loss_10);
        const float v_320 = v_313 + (v_312 * v_148);
        const float v_321 = v_319 - (v_320 * loss_10_2);
        const float v_322 = v_315 + (v_314 * v_155);
        const float v_323 = v_321 - (v_322 * loss_10_3);
        const float v_324 = v_317 + (v_316 * v_164);
        after->factors[40] = v_323 - (v_324 * loss_10_4);
        const float u_3_11 = before->factors[41];
        const float v_325 = v_318 + (u_3_10 * v_174);
        const float v_326 = u_3_11 - (v_325 * loss_11);
        const float v_327 = v_320 + (v_319 * v_178);
        const float v_328 = v_326 - (v_327 * loss_11_2);
        const float v_329 = v_322 + (v_321 * v_185);
        const float v_330 = v_328 - (v_329 * loss_11_3);
        const float v_331 = v_324 + (v_323 * v_194);
        after->factors[41] = v_330 - (v_331 * loss_11_4);
        after->factors[42] = new_d_4_2 * (r_2 * per_a_4_3);
        after->factors[43] = r_2 * loss_5_3;
        const float v_332 = r_2 * loss_6_3;
        after->factors[44] = v_332;
        const float v_333 = r_2 * loss_7_3;
        const float v_334 = new_d_6_3 * v_332;
        after->factors[45] = v_333 - (v_334 * loss_7_4);
        const float v_335 = r_2 * loss_8_3;
        const float v_336 = v_334 + (v_333 * v_104);
        after->factors[46] = v_335 - (v_336 * loss_8_4);
        const float v_337 = r_2 * loss_9_3;
        const float v_338 = v_336 + (v_335 * v_134);
        after->factors[47] = v_337 - (v_338 * loss_9_4);
        const float v_339 = r_2 * loss_10_3;
        const float v_340 = v_338 + (v_337 * v_164);
        after->factors[48] = v_339 - (v_340 * loss_10_4);
        const float v_341 = r_2 * loss_11_3;
        const float v_342 = v_340 + (v_339 * v_194);
        after->factors[49] = v_341 - (v_342 * loss_11_4);
        after->factors[50] = new_d_5_2 * (v_38 * per_a_5_3);
        const float u_5_6 = before->factors[51];
        const float v_343 = u_5_6 - (v_39 * loss_6);
        const float v_344 = v_343 - (v_43 * loss_6_2);
        const float v_345 = v_344 - (v_50 * loss_6_3);
        after->factors[51] = v_345;
        const float u_5_7 = before->factors[52];
        const float v_346 = v_39 + (u_5_6 * v_59);
        const float v_347 = u_5_7 - (v_346 * loss_7);
        const float v_348 = v_43 + (v_343 * v_63);
        const float v_349 = v_347 - (v_348 * loss_7_2);
        const float v_350 = v_50 + (v_344 * v_70);
        const float v_351 = v_349 - (v_350 * loss_7_3);
        const float v_352 = new_d_6_3 * v_345;
        after->factors[52] = v_351 - (v_352 * loss_7_4);
        const float u_5_8 = before->factors[53];
        const float v_353 = v_346 + (u_5_7 * v_84);
        const float v_354 = u_5_8 - (v_353 * loss_8);
        const float v_355 = v_348 + (v_347 * v_88);
        const float v_356 = v_354 - (v_355 * loss_8_2);
        const float v_357 = v_350 + (v_349 * v_95);
        const float v_358 = v_356 - (v_357 * loss_8_3);
        const float v_359 = v_352 + (v_351 * v_104);
        after->factors[53] = v_358 - (v_359 * loss_8_4);
        const float u_5_9 = before->factors[54];
        const float v_360 = v_353 + (u_5_8 * v_114);
        const float v_361 = u_5_9 - (v_360 * loss_9);
        const float v_362 = v_355 + (v_354 * v_118);
        const float v_363 = v_361 - (v_362 * loss_9_2);
        const float v_364 = v_357 + (v_356 * v_125);
        const float v_365 = v_363 - (v_364 * loss_9_3);
        const float v_366 = v_359 + (v_358 * v_134);
        after->factors[54] = v_365 - (v_366 * loss_9_4);
        const float u_5_10 = before->factors[55];
        const float v_367 = v_360 + (u_5_9 * v_144);
        const float v_368 = u_5_10 - (v_367 * loss_10);
        const float v_369 = v_362 + (v_361 * v_148);
        const float v_370 = v_368 - (v_369 * loss_10_2);
        const float v_371 = v_364 + (v_363 * v_155);
        const float v_372 = v_370 - (v_371 * loss_10_3);
        const float v_373 = v_366 + (v_365 * v_164);
        after->factors[55] = v_372 - (v_373 * loss_10_4);
        const float u_5_11 = before->factors[56];
        const float v_374 = v_367 + (u_5_10 * v_174);
        const float v_375 = u_5_11 - (v_374 * loss_11);
        const float v_376 = v_369 + (v_368 * v_178);
        const float v_377 = v_375 - (v_376 * loss_11_2);
        const float v_378 = v_371 + (v_370 * v_185);
        const float v_379 = v_377 - (v_378 * loss_11_3);
        const float v_380 = v_373 + (v_372 * v_194);
        after->factors[56] = v_379 - (v_380 * loss_11_4);
        after->factors[57] = new_d_6_3 * (r_3 * per_a_6_4);
        after->factors[58] = r_3 * loss_7_4;
        after->factors[59] = r_3 * loss_8_4;
        after->factors[60] = r_3 * loss_9_4;
        after->factors[61] = r_3 * loss_10_4;
        after->factors[62] = r_3 * loss_11_4;
        after->factors[63] = new_d_7_3 * (v_83 * per_a_7_4);
        const float u_7_8 = before->factors[64];
        const float v_381 = u_7_8 - (v_84 * loss_8);
        const float v_382 = v_381 - (v_88 * loss_8_2);
        const float v_383 = v_382 - (v_95 * loss_8_3);
        after->factors[64] = v_383 - (v_104 * loss_8_4);
        const float u_7_9 = before->factors[65];
        const float v_384 = v_84 + (u_7_8 * v_114);
        const float v_385 = u_7_9 - (v_384 * loss_9);
        const float v_386 = v_88 + (v_381 * v_118);
        const float v_387 = v_385 - (v_386 * loss_9_2);
        const float v_388 = v_95 + (v_382 * v_125);
        const float v_389 = v_387 - (v_388 * loss_9_3);
        const float v_390 = v_104 + (v_383 * v_134);
        after->factors[65] = v_389 - (v_390 * loss_9_4);
        const float u_7_10 = before->factors[66];
        const float v_391 = v_384 + (u_7_9 * v_144);
        const float v_392 = u_7_10 - (v_391 * loss_10);
        const float v_393 = v_386 + (v_385 * v_148);
        const float v_394 = v_392 - (v_393 * loss_10_2);
        const float v_395 = v_388 + (v_387 * v_155);
        const float v_396 = v_394 - (v_395 * loss_10_3);
        const float v_397 = v_390 + (v_389 * v_164);
        after->factors[66] = v_396 - (v_397 * loss_10_4);
        const float u_7_11 = before->factors[67];
        const float v_398 = v_391 + (u_7_10 * v_174);
        const float v_399 = u_7_11 - (v_398 * loss_11);
        const float v_400 = v_393 + (v_392 * v_178);
        const float v_401 = v_399 - (v_400 * loss_11_2);
        const float v_402 = v_395 + (v_394 * v_185);
        const float v_403 = v_401 - (v_402 * loss_11_3);
        const float v_404 = v_397 + (v_396 * v_194);
        after->factors[67] = v_403 - (v_404 * loss_11_4);
        after->factors[68] = new_d_8_3 * (v_113 * per_a_8_4);
        const float u_8_9 = before->factors[69];
        const float v_405 = u_8_9 - (v_114 * loss_9);
        const float v_406 = v_405 - (v_118 * loss_9_2);
        const float v_407 = v_406 - (v_125 * loss_9_3);
        after->factors[69] = v_407 - (v_134 * loss_9_4);
        const float u_8_10 = before->factors[70];
        const float v_408 = v_114 + (u_8_9 * v_144);
        const float v_409 = u_8_10 - (v_408 * loss_10);
        const float v_410 = v_118 + (v_405 * v_148);
        const float v_411 = v_409 - (v_410 * loss_10_2);
        const float v_412 = v_125 + (v_406 * v_155);
        const float v_413 = v_411 - (v_412 * loss_10_3);
        const float v_414 = v_134 + (v_407 * v_164);
        after->factors[70] = v_413 - (v_414 * loss_10_4);
        const float u_8_11 = before->factors[71];
        const float v_415 = v_408 + (u_8_10 * v_174);
        const float v_416 = u_8_11 - (v_415 * loss_11);
        const float v_417 = v_410 + (v_409 * v_178);
        const float v_418 = v_416 - (v_417 * loss_11_2);
        const float v_419 = v_412 + (v_411 * v_185);
        const float v_420 = v_418 - (v_419 * loss_11_3);
        const float v_421 = v_414 + (v_413 * v_194);
        after->factors[71] = v_420 - (v_421 * loss_11_4);
        after->factors[72] = new_d_9_3 * (v_143 * per_a_9_4);
        const float u_9_10 = before->factors[73];
        const float v_422 = u_9_10 - (v_144 * loss_10);
        const float v_423 = v_422 - (v_148 * loss_10_2);
        const float v_424 = v_423 - (v_155 * loss_10_3);
        after->factors[73] = v_424 - (v_164 * loss_10_4);
        const float u_9_11 = before->factors[74];
        const float v_425 = v_144 + (u_9_10 * v_174);
        const float v_426 = u_9_11 - (v_425 * loss_11);
        const float v_427 = v_148 + (v_422 * v_178);
        const float v_428 = v_426 - (v_427 * loss_11_2);
        const float v_429 = v_155 + (v_423 * v_185);
        const float v_430 = v_428 - (v_429 * loss_11_3);
        const float v_431 = v_164 + (v_424 * v_194);
        after->factors[74] = v_430 - (v_431 * loss_11_4);
        after->factors[75] = new_d_10_3 * (v_173 * per_a_10_4);
        const float u_10_11 = before->factors[76];
        const float v_432 = u_10_11 - (v_174 * loss_11);
        const float v_433 = v_432 - (v_178 * loss_11_2);
        const float v_434 = v_433 - (v_185 * loss_11_3);
        after->factors[76] = v_434 - (v_194 * loss_11_4);
        const float d_11 = before->factors[77];
        const float v_435 = u_0_11 * d_11;
        const float v_436 = u_0_11 * v_435;
        const float s = v_436 + v_176;
        const float per_a_11 = 1.0f / s;
        const float new_d_11 = d_11 * (v_176 * per_a_11);
        const float v_437 = new_d_11 * v_181;
        const float v_438 = v_181 * v_437;
        const float s_2 = v_183 + v_438;
        const float per_a_11_2 = 1.0f / s_2;
        const float new_d_11_2 = new_d_11 * (v_183 * per_a_11_2);
        const float v_439 = new_d_11_2 * v_190;
        const float v_440 = v_190 * v_439;
        const float s_3 = v_192 + v_440;
        const float per_a_11_3 = 1.0f / s_3;
        const float new_d_11_3 = new_d_11_2 * (v_192 * per_a_11_3);
        const float v_441 = new_d_11_3 * v_201;
        const float v_442 = v_201 * v_441;
        const float s_4 = v_203 + v_442;
        const float per_a_11_4 = 1.0f / s_4;
        after->factors[77] = new_d_11_3 * (v_203 * per_a_11_4);
        const float v_443 = v_175 + (v_145 + (v_115 + (v_85 + (v_60 + (v_40 + (v_25 + (v_14 + (v_7 + (d_0 +
            v_3)))))))));
        const float weighted_e = residual_0 * per_a_11;
        const float v_444 = (v_180 + (u_2_11 * v_435)) * weighted_e;
        const float e = residual_1 - v_444;
        const float weighted_e_2 = per_a_11_2 * e;
        const float v_445 = ((v_187 + (u_4_11 * v_435)) * weighted_e) + ((v_189 + (v_188 * v_437)) * weighted_e_2);
        const float e_2 = residual_2 - v_445;
        const float weighted_e_3 = per_a_11_3 * e_2;
        const float v_446 = (((v_436 + v_443) * weighted_e) + ((v_179 + (v_177 * v_437)) * weighted_e_2)) + ((v_186 +
            (v_184 * v_439)) * weighted_e_3);
        const float v_447 = ((v_196 + (u_6_11 * v_435)) * weighted_e) + ((v_198 + (v_197 * v_437)) * weighted_e_2);
        const float v_448 = v_447 + ((v_200 + (v_199 * v_439)) * weighted_e_3);
        const float e_3 = residual_3 - v_448;
        const float weighted_e_4 = per_a_11_4 * e_3;
        delta[0] = v_446 + ((v_195 + (v_193 * v_441)) * weighted_e_4);
        const float v_449 = ((v_251 + (u_1_11 * v_435)) * weighted_e) + ((v_253 + (v_252 * v_437)) * weighted_e_2);
        delta[1] = (v_449 + ((v_255 + (v_254 * v_439)) * weighted_e_3)) + ((v_257 + (v_256 * v_441)) * weighted_e_4);
        const float v_450 = ((((((((new_d_2 + v_21) + v_32) + v_47) + v_67) + v_92) + v_122) + v_152) + v_182) + v_438;
        delta[2] = ((v_444 + (v_450 * weighted_e_2)) + ((v_281 + (v_280 * v_439)) * weighted_e_3)) + ((v_283 + (v_282 *
            v_441)) * weighted_e_4);
        const float v_451 = ((v_325 + (u_3_11 * v_435)) * weighted_e) + ((v_327 + (v_326 * v_437)) * weighted_e_2);
        delta[3] = (v_451 + ((v_329 + (v_328 * v_439)) * weighted_e_3)) + ((v_331 + (v_330 * v_441)) * weighted_e_4);
        const float v_452 = (((((((new_d_4_2 + v_56) + v_76) + v_101) + v_131) + v_161) + v_191) + v_440) *
            weighted_e_3;
        delta[4] = (v_445 + v_452) + ((v_342 + (v_341 * v_441)) * weighted_e_4);
        const float v_453 = ((v_374 + (u_5_11 * v_435)) * weighted_e) + ((v_376 + (v_375 * v_437)) * weighted_e_2);
        delta[5] = (v_453 + ((v_378 + (v_377 * v_439)) * weighted_e_3)) + ((v_380 + (v_379 * v_441)) * weighted_e_4);
        delta[6] = v_448 + ((((((new_d_6_3 + v_112) + v_142) + v_172) + v_202) + v_442) * weighted_e_4);
        const float v_454 = ((v_398 + (u_7_11 * v_435)) * weighted_e) + ((v_400 + (v_399 * v_437)) * weighted_e_2);
        delta[7] = (v_454 + ((v_402 + (v_401 * v_439)) * weighted_e_3)) + ((v_404 + (v_403 * v_441)) * weighted_e_4);
        const float v_455 = ((v_415 + (u_8_11 * v_435)) * weighted_e) + ((v_417 + (v_416 * v_437)) * weighted_e_2);
        delta[8] = (v_455 + ((v_419 + (v_418 * v_439)) * weighted_e_3)) + ((v_421 + (v_420 * v_441)) * weighted_e_4);
        const float v_456 = ((v_425 + (u_9_11 * v_435)) * weighted_e) + ((v_427 + (v_426 * v_437)) * weighted_e_2);
        delta[9] = (v_456 + ((v_429 + (v_428 * v_439)) * weighted_e_3)) + ((v_431 + (v_430 * v_441)) * weighted_e_4);
        const float v_457 = ((v_174 + (u_10_11 * v_435)) * weighted_e) + ((v_178 + (v_432 * v_437)) * weighted_e_2);
        delta[10] = (v_457 + ((v_185 + (v_433 * v_439)) * weighted_e_3)) + ((v_194 + (v_434 * v_441)) * weighted_e_4);
        delta[11] = (((v_435 * weighted_e) + (v_437 * weighted_e_2)) + (v_439 * weighted_e_3)) + (v_441 * weighted_e_4);
        nis[0] = (((residual_0 * weighted_e) + (e * weighted_e_2)) + (e_2 * weighted_e_3)) + (e_3 * weighted_e_4);
        row_variance[0] = s;
        row_variance[1] = s_2;
        row_variance[2] = s_3;
        row_variance[3] = s_4;
    }

    /* row 4: d = d + K e, Bierman's update of U and D */
    /* row 5: d = d + K e, Bierman's update of U and D */
    {
        const float u_0_9 = after->factors[9];
        const float u_0_8 = after->factors[8];
        const float d_8 = after->factors[68];
        const float v = u_0_8 * d_8;
        const float u_8_9 = after->factors[69];
        const float r_4 = params->variance_pose[4];
        const float v_2 = r_4 + d_8;
        const float per_a_8 = 1.0f / ((v_2 >= 1.0e-20f) ? v_2 : 1.0f);
        const float loss_9 = u_8_9 * per_a_8;
        after->factors[9] = u_0_9 - (v * loss_9);
        const float u_0_10 = after->factors[10];
        const float d_9 = after->factors[72];
        const float v_3 = u_8_9 * d_9;
        const float v_4 = v + (u_0_9 * v_3);
        const float u_8_10 = after->factors[70];
        const float v_5 = u_8_9 * v_3;
        const float v_6 = v_2 + v_5;
        const float per_a_9 = 1.0f / v_6;
        const float loss_10 = u_8_10 * per_a_9;
        const float v_7 = u_0_10 - (v_4 * loss_10);
        after->factors[10] = v_7;
        const float u_0_11 = after->factors[11];
        const float d_10 = after->factors[75];
        const float v_8 = u_8_10 * d_10;
        const float v_9 = v_4 + (u_0_10 * v_8);
        const float u_8_11 = after->factors[71];
        const float v_10 = u_8_10 * v_8;
        const float v_11 = v_6 + v_10;
        const float per_a_10 = 1.0f / v_11;
        const float loss_11 = u_8_11 * per_a_10;
        const float v_12 = u_0_11 - (v_9 * loss_11);
        const float new_d_10 = d_10 * (v_6 * per_a_10);
        const float v_13 = new_d_10 * v_7;
        const float u_10_11 = after->factors[76];
        const float v_14 = u_10_11 - (v_8 * loss_11);
        const float r_5 = params->variance_pose[5];
        const float v_15 = r_5 + new_d_10;
        const float per_a_10_2 = 1.0f / ((v_15 >= 1.0e-20f) ? v_15 : 1.0f);
        const float loss_11_2 = v_14 * per_a_10_2;
        after->factors[11] = v_12 - (v_13 * loss_11_2);
        const float u_1_9 = after->factors[20];
        const float u_1_8 = after->factors[19];
        const float v_16 = u_1_8 * d_8;
        after->factors[20] = u_1_9 - (v_16 * loss_9);
        const float u_1_10 = after->factors[21];
        const float v_17 = v_16 + (u_1_9 * v_3);
        const float v_18 = u_1_10 - (v_17 * loss_10);
        after->factors[21] = v_18;
        const float u_1_11 = after->factors[22];
        const float v_19 = v_17 + (u_1_10 * v_8);
        const float v_20 = u_1_11 - (v_19 * loss_11);
        const float v_21 = new_d_10 * v_18;
        after->factors[22] = v_20 - (v_21 * loss_11_2);
        const float u_2_9 = after->factors[30];
        const float u_2_8 = after->factors[29];
        const float v_22 = u_2_8 * d_8;
        after->factors[30] = u_2_9 - (v_22 * loss_9);
        const float u_2_10 = after->factors[31];
        const float v_23 = v_22 + (u_2_9 * v_3);
        const float v_24 = u_2_10 - (v_23 * loss_10);
        after->factors[31] = v_24;
        const float u_2_11 = after->factors[32];
        const float v_25 = v_23 + (u_2_10 * v_8);
        const float v_26 = u_2_11 - (v_25 * loss_11);
        const float v_27 = new_d_10 * v_24;
        after->factors[32] = v_26 - (v_27 * loss_11_2);
        const float u_3_9 = after->factors[39];
        const float u_3_8 = after->factors[38];
        const float v_28 = u_3_8 * d_8;
        after->factors[39] = u_3_9 - (v_28 * loss_9);
        const float u_3_10 = after->factors[40];
        const float v_29 = v_28 + (u_3_9 * v_3);
        const float v_30 = u_3_10 - (v_29 * loss_10);
        after->factors[40] = v_30;
        const float u_3_11 = after->factors[41];
        const float v_31 = v_29 + (u_3_10 * v_8);
        const float v_32 = u_3_11 - (v_31 * loss_11);
        const float v_33 = new_d_10 * v_30;
        after->factors[41] = v_32 - (v_33 * loss_11_2);
        const float u_4_9 = after->factors[47];
        const float u_4_8 = after->factors[46];
        const float v_34 = u_4_8 * d_8;
        after->factors[47] = u_4_9 - (v_34 * loss_9);
        const float u_4_10 = after->factors[48];
        const float v_35 = v_34 + (u_4_9 * v_3);
        const float v_36 = u_4_10 - (v_35 * loss_10);
        after->factors[48] = v_36;
        const float u_4_11 = after->factors[49];
        const float v_37 = v_35 + (u_4_10 * v_8);
        const float v_38 = u_4_11 - (v_37 * loss_11);
        const float v_39 = new_d_10 * v_36;
        after->factors[49] = v_38 - (v_39 * loss_11_2);
        const float u_5_9 = after->factors[54];
        const float u_5_8 = after->factors[53];
        const float v_40 = u_5_8 * d_8;
        after->factors[54] = u_5_9 - (v_40 * loss_9);
        const float u_5_10 = after->factors[55];
        const float v_41 = v_40 + (u_5_9 * v_3);
        const float v_42 = u_5_10 - (v_41 * loss_10);
        after->factors[55] = v_42;
        const float u_5_11 = after->factors[56];
        const float v_43 = v_41 + (u_5_10 * v_8);
        const float v_44 = u_5_11 - (v_43 * loss_11);
        const float v_45 = new_d_10 * v_42;
        after->factors[56] = v_44 - (v_45 * loss_11_2);
        const float u_6_9 = after->factors[60];
        const float u_6_8 = after->factors[59];
        const float v_46 = u_6_8 * d_8;
        after->factors[60] = u_6_9 - (v_46 * loss_9);
        const float u_6_10 = after->factors[61];
        const float v_47 = v_46 + (u_6_9 * v_3);
        const float v_48 = u_6_10 - (v_47 * loss_10);
        after->factors[61] = v_48;
        const float u_6_11 = after->factors[62];
        const float v_49 = v_47 + (u_6_10 * v_8);
        const float v_50 = u_6_11 - (v_49 * loss_11);
        const float v_51 = new_d_10 * v_48;
        after->factors[62] = v_50 - (v_51 * loss_11_2);
        const float u_7_9 = after->factors[65];
        const float u_7_8 = after->factors[64];
        const float v_52 = u_7_8 * d_8;
        after->factors[65] = u_7_9 - (v_52 * loss_9);
        const float u_7_10 = after->factors[66];
        const float v_53 = v_52 + (u_7_9 * v_3);
        const float v_54 = u_7_10 - (v_53 * loss_10);
        after->factors[66] = v_54;
        const float u_7_11 = after->factors[67];
        const float v_55 = v_53 + (u_7_10 * v_8);
        const float v_56 = u_7_11 - (v_55 * loss_11);
        const float v_57 = new_d_10 * v_54;
        after->factors[67] = v_56 - (v_57 * loss_11_2);
        after->factors[68] = d_8 * (r_4 * per_a_8);
        after->factors[69] = r_4 * loss_9;
        const float v_58 = r_4 * loss_10;
        after->factors[70] = v_58;
        const float v_59 = r_4 * loss_11;
        const float v_60 = new_d_10 * v_58;
        after->factors[71] = v_59 - (v_60 * loss_11_2);
        after->factors[72] = d_9 * (v_2 * per_a_9);
        const float u_9_10 = after->factors[73];
        const float v_61 = u_9_10 - (v_3 * loss_10);
        after->factors[73] = v_61;
        const float u_9_11 = after->factors[74];
        const float v_62 = v_3 + (u_9_10 * v_8);
        const float v_63 = u_9_11 - (v_62 * loss_11);
        const float v_64 = new_d_10 * v_61;
        after->factors[74] = v_63 - (v_64 * loss_11_2);
        after->factors[75] = new_d_10 * (r_5 * per_a_10_2);
        after->factors[76] = r_5 * loss_11_2;
        const float d_11 = after->factors[77];
        const float v_65 = u_8_11 * d_11;
        const float v_66 = u_8_11 * v_65;
        const float s = v_11 + v_66;
        const float per_a_11 = 1.0f / s;
        const float new_d_11 = d_11 * (v_11 * per_a_11);
        const float v_67 = new_d_11 * v_14;
        const float v_68 = v_14 * v_67;
        const float s_2 = v_15 + v_68;
        const float per_a_11_2 = 1.0f / s_2;
        after->factors[77] = new_d_11 * (v_15 * per_a_11_2);
        const float delta_8 = delta[8];
        const float e = residual_4 - delta_8;
        const float weighted_e = per_a_11 * e;
        const float v_69 = delta[10] + ((v_8 + (u_10_11 * v_65)) * weighted_e);
        const float e_2 = residual_5 - v_69;
        const float weighted_e_2 = per_a_11_2 * e_2;
        delta[0] = (delta[0] + ((v_9 + (u_0_11 * v_65)) * weighted_e)) + ((v_13 + (v_12 * v_67)) * weighted_e_2);
        delta[1] = (delta[1] + ((v_19 + (u_1_11 * v_65)) * weighted_e)) + ((v_21 + (v_20 * v_67)) * weighted_e_2);
        delta[2] = (delta[2] + ((v_25 + (u_2_11 * v_65)) * weighted_e)) + ((v_27 + (v_26 * v_67)) * weighted_e_2);
        delta[3] = (delta[3] + ((v_31 + (u_3_11 * v_65)) * weighted_e)) + ((v_33 + (v_32 * v_67)) * weighted_e_2);
        delta[4] = (delta[4] + ((v_37 + (u_4_11 * v_65)) * weighted_e)) + ((v_39 + (v_38 * v_67)) * weighted_e_2);
        delta[5] = (delta[5] + ((v_43 + (u_5_11 * v_65)) * weighted_e)) + ((v_45 + (v_44 * v_67)) * weighted_e_2);
        delta[6] = (delta[6] + ((v_49 + (u_6_11 * v_65)) * weighted_e)) + ((v_51 + (v_50 * v_67)) * weighted_e_2);
        delta[7] = (delta[7] + ((v_55 + (u_7_11 * v_65)) * weighted_e)) + ((v_57 + (v_56 * v_67)) * weighted_e_2);
        delta[8] = (delta_8 + ((((d_8 + v_5) + v_10) + v_66) * weighted_e)) + ((v_60 + (v_59 * v_67)) * weighted_e_2);
        delta[9] = (delta[9] + ((v_62 + (u_9_11 * v_65)) * weighted_e)) + ((v_64 + (v_63 * v_67)) * weighted_e_2);
        delta[10] = v_69 + ((new_d_10 + v_68) * weighted_e_2);
        delta[11] = (delta[11] + (v_65 * weighted_e)) + (v_67 * weighted_e_2);
        nis[0] = (nis[0] + (e * weighted_e)) + (e_2 * weighted_e_2);
        row_variance[4] = s;
        row_variance[5] = s_2;
    }

    if (!(((row_variance[0] >= 1.0e-20f) == true) && ((row_variance[1] >= 1.0e-20f) == true)
          && ((row_variance[2] >= 1.0e-20f) == true) && ((row_variance[3] >= 1.0e-20f) == true)
          && ((row_variance[4] >= 1.0e-20f) == true) && ((row_variance[5] >= 1.0e-20f) == true)))
    {
        status = QUADROTOR_UD_NOT_POSITIVE;
    }
    else
    {
        if (!(((out->variance[0] >= 0.0f) == true) && ((out->variance[0] <= 1.0e30f) == true)
              && ((out->variance[1] >= 0.0f) == true) && ((out->variance[1] <= 1.0e30f) == true)
              && ((out->variance[2] >= 0.0f) == true) && ((out->variance[2] <= 1.0e30f) == true)
              && ((out->variance[3] >= 0.0f) == true) && ((out->variance[3] <= 1.0e30f) == true)
              && ((out->variance[4] >= 0.0f) == true) && ((out->variance[4] <= 1.0e30f) == true)
              && ((out->variance[5] >= 0.0f) == true) && ((out->variance[5] <= 1.0e30f) == true)))
        {
            status = QUADROTOR_UD_OVERFLOW;
        }
        else
        {
            if (!(((nis[0] >= 0.0f) == true) && ((nis[0] <= 1.0e30f) == true)))
            {
                status = QUADROTOR_UD_OVERFLOW;
            }
            else
            {
                out->nis = nis[0];

                /* accepted? */
                if ((gate <= 0.0f) || (nis[0] <= gate))
                {
                    /* x = x + d */
                    after->x = before->x + delta[0];
                    after->vx = before->vx + delta[1];
                    after->y = before->y + delta[2];
                    after->vy = before->vy + delta[3];
                    after->z = before->z + delta[4];
                    after->vz = before->vz + delta[5];
                    after->roll = before->roll + delta[6];
                    after->roll_rate = before->roll_rate + delta[7];
                    after->pitch = before->pitch + delta[8];
                    after->pitch_rate = before->pitch_rate + delta[9];
                    after->yaw = before->yaw + delta[10];
                    after->yaw_rate = before->yaw_rate + delta[11];
                    after->rejected_pose = 0U;

                    /* judge, then commit */
                    if (!quadrotor_ud_is_bounded(after->factors))
                    {
                        status = quadrotor_ud_hold_factors(after->factors);
                    }
                    if (status >= QUADROTOR_UD_OK)
                    {
                        if (!(((after->x >= -10000.0f) == true) && ((after->x <= 10000.0f) == true)
                              && ((after->vx >= -1000.0f) == true) && ((after->vx <= 1000.0f) == true)
                              && ((after->y >= -10000.0f) == true) && ((after->y <= 10000.0f) == true)
                              && ((after->vy >= -1000.0f) == true) && ((after->vy <= 1000.0f) == true)
                              && ((after->z >= -10000.0f) == true) && ((after->z <= 10000.0f) == true)
                              && ((after->vz >= -1000.0f) == true) && ((after->vz <= 1000.0f) == true)
                              && ((after->roll >= -30.0f) == true) && ((after->roll <= 30.0f) == true)
                              && ((after->roll_rate >= -100.0f) == true) && ((after->roll_rate <= 100.0f) == true)
                              && ((after->pitch >= -30.0f) == true) && ((after->pitch <= 30.0f) == true)
                              && ((after->pitch_rate >= -100.0f) == true) && ((after->pitch_rate <= 100.0f) == true)
                              && ((after->yaw >= -30.0f) == true) && ((after->yaw <= 30.0f) == true)
                              && ((after->yaw_rate >= -100.0f) == true) && ((after->yaw_rate <= 100.0f) == true)))
                        {
                            status = QUADROTOR_UD_OVERFLOW;
                        }
                    }
                }
                else
                {
                    *after = *before;
                    if (after->rejected_pose < UINT32_MAX)
                    {
                        after->rejected_pose = after->rejected_pose + 1U;
                    }
                    status = quadrotor_ud_higher(status, QUADROTOR_UD_GATED);
                }
            }
        }
    }
    return status;
}

static quadrotor_ud_status_t quadrotor_ud_update_pose_core(const quadrotor_ud_state_t *before,
                                                           quadrotor_ud_state_t *after,
                                                           const quadrotor_ud_params_t *params, const float pose[6],
                                                           const float gate, quadrotor_ud_update_pose_out_t *out)
{
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;

    if (!(((pose[0] >= -1000000.0f) == true) && ((pose[0] <= 1000000.0f) == true) && ((pose[1] >= -1000000.0f) == true)
          && ((pose[1] <= 1000000.0f) == true) && ((pose[2] >= -1000000.0f) == true)
          && ((pose[2] <= 1000000.0f) == true) && ((pose[3] >= -1000000.0f) == true)
          && ((pose[3] <= 1000000.0f) == true) && ((pose[4] >= -1000000.0f) == true)
          && ((pose[4] <= 1000000.0f) == true) && ((pose[5] >= -1000000.0f) == true)
          && ((pose[5] <= 1000000.0f) == true)))
    {
        status = QUADROTOR_UD_BAD_INPUT;
    }
    else
    {
        status = quadrotor_ud_update_pose_judged(before, after, params, pose, gate, out);
    }
    return status;
}

/* 12 multiplications. */
static quadrotor_ud_status_t quadrotor_ud_inflate_core(const quadrotor_ud_state_t *before, quadrotor_ud_state_t *after,
                                                       const float factor)
{
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;

    after->x = before->x;
    after->vx = before->vx;
    after->y = before->y;
    after->vy = before->vy;
    after->z = before->z;
    after->vz = before->vz;
    after->roll = before->roll;
    after->roll_rate = before->roll_rate;
    after->pitch = before->pitch;
    after->pitch_rate = before->pitch_rate;
    after->yaw = before->yaw;
    after->yaw_rate = before->yaw_rate;
    after->rejected_pose = before->rejected_pose;

    if (!(((factor >= 1.0f) == true) && ((factor <= 1000000.0f) == true)))
    {
        status = QUADROTOR_UD_BAD_INPUT;
    }
    else
    {
        /* P = factor P: D is scaled */
        {
            after->factors[0] = factor * before->factors[0];
            after->factors[1] = before->factors[1];
            after->factors[2] = before->factors[2];
            after->factors[3] = before->factors[3];
            after->factors[4] = before->factors[4];
            after->factors[5] = before->factors[5];
            after->factors[6] = before->factors[6];
            after->factors[7] = before->factors[7];
            after->factors[8] = before->factors[8];
            after->factors[9] = before->factors[9];
            after->factors[10] = before->factors[10];
            after->factors[11] = before->factors[11];
            after->factors[12] = factor * before->factors[12];
            after->factors[13] = before->factors[13];
            after->factors[14] = before->factors[14];
            after->factors[15] = before->factors[15];
            after->factors[16] = before->factors[16];
            after->factors[17] = before->factors[17];
            after->factors[18] = before->factors[18];
            after->factors[19] = before->factors[19];
            after->factors[20] = before->factors[20];
            after->factors[21] = before->factors[21];
            after->factors[22] = before->factors[22];
            after->factors[23] = factor * before->factors[23];
            after->factors[24] = before->factors[24];
            after->factors[25] = before->factors[25];
            after->factors[26] = before->factors[26];
            after->factors[27] = before->factors[27];
            after->factors[28] = before->factors[28];
            after->factors[29] = before->factors[29];
            after->factors[30] = before->factors[30];
            after->factors[31] = before->factors[31];
            after->factors[32] = before->factors[32];
            after->factors[33] = factor * before->factors[33];
            after->factors[34] = before->factors[34];
            after->factors[35] = before->factors[35];
            after->factors[36] = before->factors[36];
            after->factors[37] = before->factors[37];
            after->factors[38] = before->factors[38];
            after->factors[39] = before->factors[39];
            after->factors[40] = before->factors[40];
            after->factors[41] = before->factors[41];
            after->factors[42] = factor * before->factors[42];
            after->factors[43] = before->factors[43];
            after->factors[44] = before->factors[44];
            after->factors[45] = before->factors[45];
            after->factors[46] = before->factors[46];
            after->factors[47] = before->factors[47];
            after->factors[48] = before->factors[48];
            after->factors[49] = before->factors[49];
            after->factors[50] = factor * before->factors[50];
            after->factors[51] = before->factors[51];
            after->factors[52] = before->factors[52];
            after->factors[53] = before->factors[53];
            after->factors[54] = before->factors[54];
            after->factors[55] = before->factors[55];
            after->factors[56] = before->factors[56];
            after->factors[57] = factor * before->factors[57];
            after->factors[58] = before->factors[58];
            after->factors[59] = before->factors[59];
            after->factors[60] = before->factors[60];
            after->factors[61] = before->factors[61];
            after->factors[62] = before->factors[62];
            after->factors[63] = factor * before->factors[63];
            after->factors[64] = before->factors[64];
            after->factors[65] = before->factors[65];
            after->factors[66] = before->factors[66];
            after->factors[67] = before->factors[67];
            after->factors[68] = factor * before->factors[68];
            after->factors[69] = before->factors[69];
            after->factors[70] = before->factors[70];
            after->factors[71] = before->factors[71];
            after->factors[72] = factor * before->factors[72];
            after->factors[73] = before->factors[73];
            after->factors[74] = before->factors[74];
            after->factors[75] = factor * before->factors[75];
            after->factors[76] = before->factors[76];
            after->factors[77] = factor * before->factors[77];
        }

        /* judge, then commit */
        if (!quadrotor_ud_is_bounded(after->factors))
        {
            status = quadrotor_ud_hold_factors(after->factors);
        }
    }
    return status;
}

static quadrotor_ud_status_t quadrotor_ud_step_core(const quadrotor_ud_state_t *before, quadrotor_ud_state_t *after,
                                                    const quadrotor_ud_params_t *params, const float rotor_1,
                                                    const float rotor_2, const float rotor_3, const float rotor_4,
                                                    const bool has_pose, const float pose[6],
                                                    quadrotor_ud_step_out_t *out)
{
    quadrotor_ud_state_t work[2];
    quadrotor_ud_state_t *latest = &work[0];
    quadrotor_ud_state_t *spare = after;
    quadrotor_ud_status_t status = quadrotor_ud_predict_core(before, latest, params, rotor_1, rotor_2, rotor_3,
        rotor_4);

    if (status >= QUADROTOR_UD_OK)
    {
        /* pose */
        if (has_pose)
        {
            /* pose gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_pose >= params->reject_limit))
            {
                quadrotor_ud_status_t own = quadrotor_ud_inflate_core(latest, &work[1], params->inflation);
                quadrotor_ud_status_t highest = status;

                if (own >= QUADROTOR_UD_OK)
                {
                    highest = quadrotor_ud_higher(highest, own);
                    own = quadrotor_ud_update_pose_core(&work[1], spare, params, pose, 0.0f, &out->pose);
                }
                out->status_pose = own;
                if (own >= QUADROTOR_UD_OK)
                {
                    latest = spare;
                    status = quadrotor_ud_higher(highest, own);
                    status = quadrotor_ud_higher(status, QUADROTOR_UD_RECOVERED);
                }
                else
                {
                    for (uint32_t i = 0U; i < 6U; i++)
                    {
                        out->pose.innovation[i] = 0.0f;
                    }
                    for (uint32_t i = 0U; i < 6U; i++)
                    {
                        out->pose.variance[i] = 0.0f;
                    }
                    out->pose.nis = 0.0f;
                    status = quadrotor_ud_higher(status, QUADROTOR_UD_SKIPPED);
                }
            }
            else
            {
                quadrotor_ud_status_t own = quadrotor_ud_update_pose_core(latest, spare, params, pose,
                    params->gate_pose, &out->pose);

                out->status_pose = own;
                if (own >= QUADROTOR_UD_OK)
                {
                    latest = spare;
                    status = quadrotor_ud_higher(status, own);
                }
                else
                {
                    for (uint32_t i = 0U; i < 6U; i++)
                    {
                        out->pose.innovation[i] = 0.0f;
                    }
                    for (uint32_t i = 0U; i < 6U; i++)
                    {
                        out->pose.variance[i] = 0.0f;
                    }
                    out->pose.nis = 0.0f;
                    status = quadrotor_ud_higher(status, QUADROTOR_UD_SKIPPED);
                }
            }
        }
        else
        {
            for (uint32_t i = 0U; i < 6U; i++)
            {
                out->pose.innovation[i] = 0.0f;
            }
            for (uint32_t i = 0U; i < 6U; i++)
            {
                out->pose.variance[i] = 0.0f;
            }
            out->pose.nis = 0.0f;
            out->status_pose = QUADROTOR_UD_OK;
        }
        if (latest != after)
        {
            *after = *latest;
        }
    }
    return status;
}

quadrotor_ud_status_t quadrotor_ud_init(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params)
{
    quadrotor_ud_state_t after;
    const quadrotor_ud_status_t status = quadrotor_ud_init_core(&after, params);

    if (status >= QUADROTOR_UD_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_ud_status_t quadrotor_ud_predict(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                           const quadrotor_ud_predict_in_t *in)
{
    quadrotor_ud_state_t after;
    const quadrotor_ud_status_t status = quadrotor_ud_predict_core(state, &after, params, in->rotor_1, in->rotor_2,
        in->rotor_3, in->rotor_4);

    if (status >= QUADROTOR_UD_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_ud_status_t quadrotor_ud_update_pose(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                               const quadrotor_ud_update_pose_in_t *in,
                                               quadrotor_ud_update_pose_out_t *out)
{
    quadrotor_ud_state_t after;
    quadrotor_ud_update_pose_out_t answer;
    const quadrotor_ud_status_t status = quadrotor_ud_update_pose_core(state, &after, params, in->pose,
        params->gate_pose, &answer);

    if (status >= QUADROTOR_UD_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

quadrotor_ud_status_t quadrotor_ud_step(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                        const quadrotor_ud_step_in_t *in, quadrotor_ud_step_out_t *out)
{
    quadrotor_ud_step_out_t answer;
    const quadrotor_ud_status_t status = quadrotor_ud_step_core(state, state, params, in->rotor_1, in->rotor_2,
        in->rotor_3, in->rotor_4, in->has_pose, in->pose, &answer);

    if (status >= QUADROTOR_UD_OK)
    {
        *out = answer;
    }
    return status;
}

quadrotor_ud_status_t quadrotor_ud_inflate(quadrotor_ud_state_t *state, const quadrotor_ud_params_t *params,
                                           const quadrotor_ud_inflate_in_t *in)
{
    quadrotor_ud_state_t after;
    const quadrotor_ud_status_t status = quadrotor_ud_inflate_core(state, &after, in->factor);

    (void)params;

    if (status >= QUADROTOR_UD_OK)
    {
        *state = after;
    }
    return status;
}

/* The hash of the model, as in the header. */
const char *quadrotor_ud_model(void)
{
    return "f4dfb1d1";
}

/* A sentence for a status. */
const char *quadrotor_ud_status_text(quadrotor_ud_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case QUADROTOR_UD_OK:
            text = "ok";
            break;
        case QUADROTOR_UD_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case QUADROTOR_UD_CLAMPED:
            text = "a value (a variance, a command) was held at its limit";
            break;
        case QUADROTOR_UD_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case QUADROTOR_UD_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case QUADROTOR_UD_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case QUADROTOR_UD_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case QUADROTOR_UD_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case QUADROTOR_UD_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
