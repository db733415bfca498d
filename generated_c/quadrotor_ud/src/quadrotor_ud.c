/* quadrotor_ud: see quadrotor_ud.h. Written by plantc 0.1.0 from model e19130e8. */
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
        float variance = factors[at];
        uint32_t weight = at;

        if (!((factors[at] >= 0.0f) == true))
        {
            status = QUADROTOR_UD_NOT_POSITIVE;
        }
        for (uint32_t j = i + 1U; j < 12U; j++)
        {
            const float u = factors[at + (j - i)];

            weight = weight + ((12U + 1U) - j);
            variance = variance + (u * (u * factors[weight]));
        }
        scale[i] = 1.0f;
        if (variance > highest[i])
        {
            scale[i] = sqrtf(highest[i] / variance);
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
        status = quadrotor_ud_hold_factors(after->factors);
    }
    return status;
}

/* 1259 additions, 1495 multiplications, 11 divisions, 73 negations, 11 selections, cosf 3 times, sinf 3 times. */
static quadrotor_ud_status_t quadrotor_ud_predict_core(const quadrotor_ud_state_t *before, quadrotor_ud_state_t *after,
                                                       const quadrotor_ud_params_t *params, const float rotor_1,
                                                       const float rotor_2, const float rotor_3, const float rotor_4)
{
    quadrotor_ud_status_t status = QUADROTOR_UD_OK;

    after->rejected_pose = before->rejected_pose;

    if (!(((rotor_1 >= -1000.0f) == true) && ((rotor_1 <= 1000.0f) == true) && ((rotor_2 >= -1000.0f) == true)
          && ((rotor_2 <= 1000.0f) == true) && ((rotor_3 >= -1000.0f) == true) && ((rotor_3 <= 1000.0f) == true)
          && ((rotor_4 >= -1000.0f) == true) && ((rotor_4 <= 1000.0f) == true)))
    {
        status = QUADROTOR_UD_BAD_INPUT;
    }
    else
    {
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
        /* roll_rate' = -0.753086419753 (pitch_rate yaw_rate) - 0.0128395061728 pitch_rate (rotor_1 - rotor_2 +
         * rotor_3 - rotor_4) + 0.00160592592593 (rotor_3^2 - (rotor_1^2 + rotor_2^2) + rotor_4^2) */
        /* pitch' = pitch_rate */
        /* pitch_rate' = 0.753086419753 (roll_rate yaw_rate) + 0.0128395061728 roll_rate (rotor_1 - rotor_2 + rotor_3
         * - rotor_4) + 0.00160592592593 (rotor_2^2 - rotor_1^2 + rotor_3^2 - rotor_4^2) */
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
        const float v_19 = ((0.75308645f * (roll_rate * yaw_rate)) + (v_17 * (roll_rate * 0.012839506f))) +
            (0.001605926f * ((v_10 + (v_8 - v_7)) - v_11));
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
            /* U D U' = F U D U' F' + Q, by weighted Gram-Schmidt */
            {
                const float q_11_11 = params->variance_step_yaw_rate;
                const float d_11 = before->factors[77];
                const float d_11_2 = q_11_11 + d_11;
                const float per_d_11 = 1.0f / ((d_11_2 >= 1.0e-30f) ? d_11_2 : 1.0f);
                const float u_10_11 = before->factors[76];
                const float v_22 = 0.025f + u_10_11;
                const float u_10_11_2 = per_d_11 * (d_11 * v_22);
                const float v_23 = -u_10_11_2;
                const float v_24 = q_11_11 * v_23;
                const float q_10_10 = params->variance_step_yaw;
                const float d_10 = before->factors[75];
                const float v_25 = v_22 - u_10_11_2;
                const float v_26 = d_11 * v_25;
                const float d_10_2 = (v_23 * v_24) + (q_10_10 + (d_10 + (v_25 * v_26)));
                const float per_d_10 = 1.0f / ((d_10_2 >= 1.0e-30f) ? d_10_2 : 1.0f);
                const float u_9_11 = before->factors[74];
                const float u_7_11 = before->factors[67];
                const float v_27 = f_9_11 + (u_9_11 + (f_9_7 * u_7_11));
                const float u_9_11_2 = per_d_11 * (d_11 * v_27);
                const float v_28 = -u_9_11_2;
                const float u_9_10 = before->factors[73];
                const float u_7_10 = before->factors[66];
                const float v_29 = u_9_10 + (f_9_7 * u_7_10);
                const float v_30 = v_27 - u_9_11_2;
                const float u_9_10_2 = per_d_10 * ((v_28 * v_24) + ((d_10 * v_29) + (v_30 * v_26)));
                const float v_31 = -u_9_10_2;
                const float v_32 = q_10_10 * v_31;
                const float v_33 = v_28 - (v_23 * u_9_10_2);
                const float v_34 = q_11_11 * v_33;
                const float q_9_9 = params->variance_step_pitch_rate;
                const float v_35 = v_30 - (v_25 * u_9_10_2);
                const float v_36 = d_11 * v_35;
                const float v_37 = v_29 - u_9_10_2;
                const float v_38 = d_10 * v_37;
                const float u_7_9 = before->factors[65];
                const float v_39 = 1.0f + (f_9_7 * u_7_9);
                const float d_9 = before->factors[72];
                const float v_40 = d_9 * v_39;
                const float d_7 = before->factors[63];
                const float v_41 = f_9_7 * d_7;
                const float u_7_8 = before->factors[64];
                const float v_42 = f_9_7 * u_7_8;
                const float d_8 = before->factors[68];
                const float v_43 = d_8 * v_42;
                const float v_44 = q_9_9 + ((v_35 * v_36) + ((v_37 * v_38) + ((v_39 * v_40) + ((f_9_7 * v_41) + (v_42 *
                    v_43)))));
                const float d_9_2 = (v_31 * v_32) + ((v_33 * v_34) + v_44);
                const float per_d_9 = 1.0f / ((d_9_2 >= 1.0e-30f) ? d_9_2 : 1.0f);
                const float u_8_11 = before->factors[71];
                const float v_45 = u_8_11 + (0.025f * u_9_11);
                const float u_8_11_2 = per_d_11 * (d_11 * v_45);
                const float v_46 = -u_8_11_2;
                const float u_8_10 = before->factors[70];
                const float v_47 = u_8_10 + (0.025f * u_9_10);
                const float v_48 = v_45 - u_8_11_2;
                const float u_8_10_2 = per_d_10 * ((v_46 * v_24) + ((d_10 * v_47) + (v_48 * v_26)));
                const float v_49 = -u_8_10_2;
                const float v_50 = v_46 - (v_23 * u_8_10_2);
                const float v_51 = v_48 - (v_25 * u_8_10_2);
                const float v_52 = v_47 - u_8_10_2;
                const float u_8_9 = before->factors[69];
                const float v_53 = 0.025f + u_8_9;
                const float v_54 = (v_49 * v_32) + ((v_50 * v_34) + ((v_51 * v_36) + ((v_52 * v_38) + (v_43 + (v_53 *
                    v_40)))));
                const float u_8_9_2 = per_d_9 * v_54;
                const float v_55 = -u_8_9_2;
                const float v_56 = q_9_9 * v_55;
                const float v_57 = -(f_9_7 * u_8_9_2);
                const float v_58 = d_7 * v_57;
                const float v_59 = v_49 - (v_31 * u_8_9_2);
                const float v_60 = q_10_10 * v_59;
                const float v_61 = v_50 - (v_33 * u_8_9_2);
                const float v_62 = q_11_11 * v_61;
                const float q_8_8 = params->variance_step_pitch;
                const float v_63 = v_51 - (v_35 * u_8_9_2);
                const float v_64 = d_11 * v_63;
                const float v_65 = v_52 - (v_37 * u_8_9_2);
                const float v_66 = d_10 * v_65;
                const float v_67 = 1.0f - (v_42 * u_8_9_2);
                const float v_68 = d_8 * v_67;
                const float v_69 = v_53 - (v_39 * u_8_9_2);
                const float v_70 = d_9 * v_69;
                const float v_71 = (v_61 * v_62) + (q_8_8 + ((v_63 * v_64) + ((v_65 * v_66) + ((v_67 * v_68) + (v_69 *
                    v_70)))));
                const float d_8_2 = (v_55 * v_56) + ((v_57 * v_58) + ((v_59 * v_60) + v_71));
                const float per_d_8 = 1.0f / ((d_8_2 >= 1.0e-30f) ? d_8_2 : 1.0f);
                const float v_72 = f_7_11 + (u_7_11 + (f_7_9 * u_9_11));
                const float u_7_11_2 = per_d_11 * (d_11 * v_72);
                const float v_73 = -u_7_11_2;
                const float v_74 = u_7_10 + (f_7_9 * u_9_10);
                const float v_75 = v_72 - u_7_11_2;
                const float u_7_10_2 = per_d_10 * ((v_73 * v_24) + ((d_10 * v_74) + (v_75 * v_26)));
                const float v_76 = -u_7_10_2;
                const float v_77 = v_73 - (v_23 * u_7_10_2);
                const float v_78 = v_75 - (v_25 * u_7_10_2);
                const float v_79 = v_74 - u_7_10_2;
                const float v_80 = f_7_9 + u_7_9;
                const float v_81 = (v_77 * v_34) + ((v_78 * v_36) + ((v_79 * v_38) + ((v_80 * v_40) + (v_41 + (u_7_8 *
                    v_43)))));
                const float u_7_9_2 = per_d_9 * ((v_76 * v_32) + v_81);
                const float v_82 = -u_7_9_2;
                const float v_83 = v_76 - (v_31 * u_7_9_2);
                const float v_84 = v_77 - (v_33 * u_7_9_2);
                const float v_85 = v_78 - (v_35 * u_7_9_2);
                const float v_86 = v_79 - (v_37 * u_7_9_2);
                const float v_87 = v_80 - (v_39 * u_7_9_2);
                const float v_88 = 1.0f - (f_9_7 * u_7_9_2);
                const float v_89 = u_7_8 - (v_42 * u_7_9_2);
                const float v_90 = (v_84 * v_62) + ((v_85 * v_64) + ((v_86 * v_66) + ((v_87 * v_70) + ((v_88 * v_58) +
                    (v_89 * v_68)))));
                const float u_7_8_2 = per_d_8 * ((v_82 * v_56) + ((v_83 * v_60) + v_90));
                const float v_91 = -u_7_8_2;
                const float v_92 = q_8_8 * v_91;
                const float v_93 = v_82 - (v_55 * u_7_8_2);
                const float v_94 = q_9_9 * v_93;
                const float v_95 = v_83 - (v_59 * u_7_8_2);
                const float v_96 = q_10_10 * v_95;
                const float v_97 = v_84 - (v_61 * u_7_8_2);
                const float v_98 = q_11_11 * v_97;
                const float q_7_7 = params->variance_step_roll_rate;
                const float v_99 = v_85 - (v_63 * u_7_8_2);
                const float v_100 = d_11 * v_99;
                const float v_101 = v_86 - (v_65 * u_7_8_2);
                const float v_102 = d_10 * v_101;
                const float v_103 = v_87 - (v_69 * u_7_8_2);
                const float v_104 = d_9 * v_103;
                const float v_105 = v_88 - (v_57 * u_7_8_2);
                const float v_106 = d_7 * v_105;
                const float v_107 = v_89 - (v_67 * u_7_8_2);
                const float v_108 = d_8 * v_107;
                const float v_109 = (v_99 * v_100) + ((v_101 * v_102) + ((v_103 * v_104) + ((v_105 * v_106) + (v_107 *
                    v_108))));
                const float d_7_2 = (v_91 * v_92) + ((v_93 * v_94) + ((v_95 * v_96) + ((v_97 * v_98) + (q_7_7 +
                    v_109))));
                const float per_d_7 = 1.0f / ((d_7_2 >= 1.0e-30f) ? d_7_2 : 1.0f);
                const float u_6_11 = before->factors[62];
                const float v_110 = u_6_11 + (0.025f * u_7_11);
                const float u_6_11_2 = per_d_11 * (d_11 * v_110);
                const float v_111 = -u_6_11_2;
                const float u_6_10 = before->factors[61];
                const float v_112 = u_6_10 + (0.025f * u_7_10);
                const float v_113 = v_110 - u_6_11_2;
                const float u_6_10_2 = per_d_10 * ((v_111 * v_24) + ((d_10 * v_112) + (v_113 * v_26)));
                const float v_114 = -u_6_10_2;
                const float v_115 = v_111 - (v_23 * u_6_10_2);
                const float v_116 = v_113 - (v_25 * u_6_10_2);
                const float v_117 = v_112 - u_6_10_2;
                const float u_6_9 = before->factors[60];
                const float v_118 = u_6_9 + (0.025f * u_7_9);
                const float u_6_7 = before->factors[58];
                const float v_119 = 0.025f + u_6_7;
                const float u_6_8 = before->factors[59];
                const float v_120 = u_6_8 + (0.025f * u_7_8);
                const float v_121 = (v_116 * v_36) + ((v_117 * v_38) + ((v_118 * v_40) + ((v_119 * v_41) + (v_120 *
                    v_43))));
                const float u_6_9_2 = per_d_9 * ((v_114 * v_32) + ((v_115 * v_34) + v_121));
                const float v_122 = -u_6_9_2;
                const float v_123 = v_114 - (v_31 * u_6_9_2);
                const float v_124 = v_115 - (v_33 * u_6_9_2);
                const float v_125 = v_116 - (v_35 * u_6_9_2);
                const float v_126 = v_117 - (v_37 * u_6_9_2);
                const float v_127 = v_118 - (v_39 * u_6_9_2);
                const float v_128 = v_119 - (f_9_7 * u_6_9_2);
                const float v_129 = v_120 - (v_42 * u_6_9_2);
                const float v_130 = (v_125 * v_64) + ((v_126 * v_66) + ((v_127 * v_70) + ((v_128 * v_58) + (v_129 *
                    v_68))));
                const float u_6_8_2 = per_d_8 * ((v_122 * v_56) + ((v_123 * v_60) + ((v_124 * v_62) + v_130)));
                const float v_131 = -u_6_8_2;
                const float v_132 = v_122 - (v_55 * u_6_8_2);
                const float v_133 = v_123 - (v_59 * u_6_8_2);
                const float v_134 = v_124 - (v_61 * u_6_8_2);
                const float v_135 = v_125 - (v_63 * u_6_8_2);
                const float v_136 = v_126 - (v_65 * u_6_8_2);
                const float v_137 = v_127 - (v_69 * u_6_8_2);
                const float v_138 = v_128 - (v_57 * u_6_8_2);
                const float v_139 = v_129 - (v_67 * u_6_8_2);
                const float v_140 = (v_135 * v_100) + ((v_136 * v_102) + ((v_137 * v_104) + ((v_138 * v_106) + (v_139 *
                    v_108))));
                const float u_6_7_2 = per_d_7 * ((v_131 * v_92) + ((v_132 * v_94) + ((v_133 * v_96) + ((v_134 * v_98) +
                    v_140))));
                const float v_141 = -u_6_7_2;
                const float v_142 = q_7_7 * v_141;
                const float v_143 = v_131 - (v_91 * u_6_7_2);
                const float v_144 = q_8_8 * v_143;
                const float v_145 = v_132 - (v_93 * u_6_7_2);
                const float v_146 = q_9_9 * v_145;
                const float v_147 = v_133 - (v_95 * u_6_7_2);
                const float v_148 = q_10_10 * v_147;
                const float v_149 = v_134 - (v_97 * u_6_7_2);
                const float v_150 = q_11_11 * v_149;
                const float q_6_6 = params->variance_step_roll;
                const float v_151 = v_135 - (v_99 * u_6_7_2);
                const float v_152 = d_11 * v_151;
                const float v_153 = v_136 - (v_101 * u_6_7_2);
                const float v_154 = d_10 * v_153;
                const float v_155 = v_137 - (v_103 * u_6_7_2);
                const float v_156 = d_9 * v_155;
                const float v_157 = v_139 - (v_107 * u_6_7_2);
                const float v_158 = d_8 * v_157;
                const float d_6 = before->factors[57];
                const float v_159 = v_138 - (v_105 * u_6_7_2);
                const float v_160 = d_7 * v_159;
                const float v_161 = (v_151 * v_152) + ((v_153 * v_154) + ((v_155 * v_156) + ((v_157 * v_158) + (d_6 +
                    (v_159 * v_160)))));
                const float v_162 = (v_143 * v_144) + ((v_145 * v_146) + ((v_147 * v_148) + ((v_149 * v_150) + (q_6_6 +
                    v_161))));
                const float d_6_2 = (v_141 * v_142) + v_162;
                const float per_d_6 = 1.0f / ((d_6_2 >= 1.0e-30f) ? d_6_2 : 1.0f);
                const float u_5_11 = before->factors[56];
                const float v_163 = (u_5_11 + (f_5_6 * u_6_11)) + (f_5_8 * u_8_11);
                const float u_5_11_2 = per_d_11 * (d_11 * v_163);
                const float v_164 = -u_5_11_2;
                const float u_5_10 = before->factors[55];
                const float v_165 = (u_5_10 + (f_5_6 * u_6_10)) + (f_5_8 * u_8_10);
                const float v_166 = v_163 - u_5_11_2;
                const float u_5_10_2 = per_d_10 * ((v_164 * v_24) + ((d_10 * v_165) + (v_166 * v_26)));
                const float v_167 = -u_5_10_2;
                const float v_168 = v_164 - (v_23 * u_5_10_2);
                const float v_169 = v_166 - (v_25 * u_5_10_2);
                const float v_170 = v_165 - u_5_10_2;
                const float u_5_9 = before->factors[54];
                const float v_171 = (u_5_9 + (f_5_6 * u_6_9)) + (f_5_8 * u_8_9);
                const float u_5_7 = before->factors[52];
                const float v_172 = u_5_7 + (f_5_6 * u_6_7);
                const float u_5_8 = before->factors[53];
                const float v_173 = f_5_8 + (u_5_8 + (f_5_6 * u_6_8));
                const float v_174 = (v_169 * v_36) + ((v_170 * v_38) + ((v_171 * v_40) + ((v_172 * v_41) + (v_173 *
                    v_43))));
                const float u_5_9_2 = per_d_9 * ((v_167 * v_32) + ((v_168 * v_34) + v_174));
                const float v_175 = -u_5_9_2;
                const float v_176 = v_167 - (v_31 * u_5_9_2);
                const float v_177 = v_168 - (v_33 * u_5_9_2);
                const float v_178 = v_169 - (v_35 * u_5_9_2);
                const float v_179 = v_170 - (v_37 * u_5_9_2);
                const float v_180 = v_171 - (v_39 * u_5_9_2);
                const float v_181 = v_172 - (f_9_7 * u_5_9_2);
                const float v_182 = v_173 - (v_42 * u_5_9_2);
                const float v_183 = (v_178 * v_64) + ((v_179 * v_66) + ((v_180 * v_70) + ((v_181 * v_58) + (v_182 *
                    v_68))));
                const float u_5_8_2 = per_d_8 * ((v_175 * v_56) + ((v_176 * v_60) + ((v_177 * v_62) + v_183)));
                const float v_184 = -u_5_8_2;
                const float v_185 = v_175 - (v_55 * u_5_8_2);
                const float v_186 = v_176 - (v_59 * u_5_8_2);
                const float v_187 = v_177 - (v_61 * u_5_8_2);
                const float v_188 = v_178 - (v_63 * u_5_8_2);
                const float v_189 = v_179 - (v_65 * u_5_8_2);
                const float v_190 = v_180 - (v_69 * u_5_8_2);
                const float v_191 = v_181 - (v_57 * u_5_8_2);
                const float v_192 = v_182 - (v_67 * u_5_8_2);
                const float v_193 = (v_188 * v_100) + ((v_189 * v_102) + ((v_190 * v_104) + ((v_191 * v_106) + (v_192 *
                    v_108))));
                const float u_5_7_2 = per_d_7 * ((v_184 * v_92) + ((v_185 * v_94) + ((v_186 * v_96) + ((v_187 * v_98) +
                    v_193))));
                const float v_194 = -u_5_7_2;
                const float v_195 = v_184 - (v_91 * u_5_7_2);
                const float v_196 = v_185 - (v_93 * u_5_7_2);
                const float v_197 = v_186 - (v_95 * u_5_7_2);
                const float v_198 = v_187 - (v_97 * u_5_7_2);
                const float v_199 = v_188 - (v_99 * u_5_7_2);
                const float v_200 = v_189 - (v_101 * u_5_7_2);
                const float v_201 = v_190 - (v_103 * u_5_7_2);
                const float v_202 = v_192 - (v_107 * u_5_7_2);
                const float u_5_6 = before->factors[51];
                const float v_203 = f_5_6 + u_5_6;
                const float v_204 = v_191 - (v_105 * u_5_7_2);
                const float v_205 = (v_200 * v_154) + ((v_201 * v_156) + ((v_202 * v_158) + ((d_6 * v_203) + (v_204 *
                    v_160))));
                const float v_206 = (v_195 * v_144) + ((v_196 * v_146) + ((v_197 * v_148) + ((v_198 * v_150) + ((v_199 *
                    v_152) + v_205))));
                const float u_5_6_2 = per_d_6 * ((v_194 * v_142) + v_206);
                const float v_207 = -u_5_6_2;
                const float v_208 = q_6_6 * v_207;
                const float v_209 = v_194 - (v_141 * u_5_6_2);
                const float v_210 = q_7_7 * v_209;
                const float v_211 = v_195 - (v_143 * u_5_6_2);
                const float v_212 = q_8_8 * v_211;
                const float v_213 = v_196 - (v_145 * u_5_6_2);
                const float v_214 = q_9_9 * v_213;
                const float v_215 = v_197 - (v_147 * u_5_6_2);
                const float v_216 = q_10_10 * v_215;
                const float v_217 = v_198 - (v_149 * u_5_6_2);
                const float v_218 = q_11_11 * v_217;
                const float q_5_5 = params->variance_step_vz;
                const float v_219 = v_199 - (v_151 * u_5_6_2);
                const float v_220 = d_11 * v_219;
                const float v_221 = v_200 - (v_153 * u_5_6_2);
                const float v_222 = d_10 * v_221;
                const float v_223 = v_201 - (v_155 * u_5_6_2);
                const float v_224 = d_9 * v_223;
                const float v_225 = v_202 - (v_157 * u_5_6_2);
                const float v_226 = d_8 * v_225;
                const float v_227 = v_204 - (v_159 * u_5_6_2);
                const float v_228 = d_7 * v_227;
                const float d_5 = before->factors[50];
                const float v_229 = v_203 - u_5_6_2;
                const float v_230 = d_6 * v_229;
                const float v_231 = (v_221 * v_222) + ((v_223 * v_224) + ((v_225 * v_226) + ((v_227 * v_228) + (d_5 +
                    (v_229 * v_230)))));
                const float v_232 = (v_213 * v_214) + ((v_215 * v_216) + ((v_217 * v_218) + (q_5_5 + ((v_219 * v_220) +
                    v_231))));
                const float d_5_2 = (v_207 * v_208) + ((v_209 * v_210) + ((v_211 * v_212) + v_232));
                const float per_d_5 = 1.0f / ((d_5_2 >= 1.0e-30f) ? d_5_2 : 1.0f);
                const float v_233 = before->factors[49] + (0.025f * u_5_11);
                const float u_4_11 = per_d_11 * (d_11 * v_233);
                const float v_234 = -u_4_11;
                const float v_235 = before->factors[48] + (0.025f * u_5_10);
                const float v_236 = v_233 - u_4_11;
                const float u_4_10 = per_d_10 * ((v_234 * v_24) + ((d_10 * v_235) + (v_236 * v_26)));
                const float v_237 = -u_4_10;
                const float v_238 = v_234 - (v_23 * u_4_10);
                const float v_239 = v_236 - (v_25 * u_4_10);
                const float v_240 = v_235 - u_4_10;
                const float v_241 = before->factors[47] + (0.025f * u_5_9);
                const float v_242 = before->factors[45] + (0.025f * u_5_7);
                const float v_243 = before->factors[46] + (0.025f * u_5_8);
                const float v_244 = (v_239 * v_36) + ((v_240 * v_38) + ((v_241 * v_40) + ((v_242 * v_41) + (v_243 *
                    v_43))));
                const float u_4_9 = per_d_9 * ((v_237 * v_32) + ((v_238 * v_34) + v_244));
                const float v_245 = -u_4_9;
                const float v_246 = v_237 - (v_31 * u_4_9);
                const float v_247 = v_238 - (v_33 * u_4_9);
                const float v_248 = v_239 - (v_35 * u_4_9);
                const float v_249 = v_240 - (v_37 * u_4_9);
                const float v_250 = v_241 - (v_39 * u_4_9);
                const float v_251 = v_242 - (f_9_7 * u_4_9);
                const float v_252 = v_243 - (v_42 * u_4_9);
                const float v_253 = (v_248 * v_64) + ((v_249 * v_66) + ((v_250 * v_70) + ((v_251 * v_58) + (v_252 *
                    v_68))));
                const float u_4_8 = per_d_8 * ((v_245 * v_56) + ((v_246 * v_60) + ((v_247 * v_62) + v_253)));
                const float v_254 = -u_4_8;
                const float v_255 = v_245 - (v_55 * u_4_8);
                const float v_256 = v_246 - (v_59 * u_4_8);
                const float v_257 = v_247 - (v_61 * u_4_8);
                const float v_258 = v_248 - (v_63 * u_4_8);
                const float v_259 = v_249 - (v_65 * u_4_8);
                const float v_260 = v_250 - (v_69 * u_4_8);
                const float v_261 = v_251 - (v_57 * u_4_8);
                const float v_262 = v_252 - (v_67 * u_4_8);
                const float v_263 = (v_258 * v_100) + ((v_259 * v_102) + ((v_260 * v_104) + ((v_261 * v_106) + (v_262 *
                    v_108))));
                const float u_4_7 = per_d_7 * ((v_254 * v_92) + ((v_255 * v_94) + ((v_256 * v_96) + ((v_257 * v_98) +
                    v_263))));
                const float v_264 = -u_4_7;
                const float v_265 = v_254 - (v_91 * u_4_7);
                const float v_266 = v_255 - (v_93 * u_4_7);
                const float v_267 = v_256 - (v_95 * u_4_7);
                const float v_268 = v_257 - (v_97 * u_4_7);
                const float v_269 = v_258 - (v_99 * u_4_7);
                const float v_270 = v_259 - (v_101 * u_4_7);
                const float v_271 = v_260 - (v_103 * u_4_7);
                const float v_272 = v_262 - (v_107 * u_4_7);
                const float v_273 = before->factors[44] + (0.025f * u_5_6);
                const float v_274 = v_261 - (v_105 * u_4_7);
                const float v_275 = (v_270 * v_154) + ((v_271 * v_156) + ((v_272 * v_158) + ((d_6 * v_273) + (v_274 *
                    v_160))));
                const float v_276 = (v_265 * v_144) + ((v_266 * v_146) + ((v_267 * v_148) + ((v_268 * v_150) + ((v_269 *
                    v_152) + v_275))));
                const float u_4_6 = per_d_6 * ((v_264 * v_142) + v_276);
                const float v_277 = -u_4_6;
                const float v_278 = v_264 - (v_141 * u_4_6);
                const float v_279 = v_265 - (v_143 * u_4_6);
                const float v_280 = v_266 - (v_145 * u_4_6);
                const float v_281 = v_267 - (v_147 * u_4_6);
                const float v_282 = v_268 - (v_149 * u_4_6);
                const float v_283 = v_269 - (v_151 * u_4_6);
                const float v_284 = v_270 - (v_153 * u_4_6);
                const float v_285 = v_271 - (v_155 * u_4_6);
                const float v_286 = v_272 - (v_157 * u_4_6);
                const float v_287 = v_274 - (v_159 * u_4_6);
                const float v_288 = 0.025f + before->factors[43];
                const float v_289 = v_273 - u_4_6;
                const float v_290 = (v_285 * v_224) + ((v_286 * v_226) + ((v_287 * v_228) + ((d_5 * v_288) + (v_289 *
                    v_230))));
                const float v_291 = (v_280 * v_214) + ((v_281 * v_216) + ((v_282 * v_218) + ((v_283 * v_220) + ((v_284 *
                    v_222) + v_290))));
                const float u_4_5 = per_d_5 * ((v_277 * v_208) + ((v_278 * v_210) + ((v_279 * v_212) + v_291)));
                const float v_292 = -u_4_5;
                const float v_293 = q_5_5 * v_292;
                const float v_294 = v_277 - (v_207 * u_4_5);
                const float v_295 = q_6_6 * v_294;
                const float v_296 = v_278 - (v_209 * u_4_5);
                const float v_297 = q_7_7 * v_296;
                const float v_298 = v_279 - (v_211 * u_4_5);
                const float v_299 = q_8_8 * v_298;
                const float v_300 = v_280 - (v_213 * u_4_5);
                const float v_301 = q_9_9 * v_300;
                const float v_302 = v_281 - (v_215 * u_4_5);
                const float v_303 = q_10_10 * v_302;
                const float v_304 = v_282 - (v_217 * u_4_5);
                const float v_305 = q_11_11 * v_304;
                const float q_4_4 = params->variance_step_z;
                const float v_306 = v_283 - (v_219 * u_4_5);
                const float v_307 = d_11 * v_306;
                const float v_308 = v_284 - (v_221 * u_4_5);
                const float v_309 = d_10 * v_308;
                const float v_310 = v_285 - (v_223 * u_4_5);
                const float v_311 = d_9 * v_310;
                const float v_312 = v_286 - (v_225 * u_4_5);
                const float v_313 = d_8 * v_312;
                const float v_314 = v_287 - (v_227 * u_4_5);
                const float v_315 = d_7 * v_314;
                const float v_316 = v_289 - (v_229 * u_4_5);
                const float v_317 = d_6 * v_316;
                const float d_4 = before->factors[42];
                const float v_318 = v_288 - u_4_5;
                const float v_319 = d_5 * v_318;
                const float v_320 = (v_310 * v_311) + ((v_312 * v_313) + ((v_314 * v_315) + ((v_316 * v_317) + (d_4 +
                    (v_318 * v_319)))));
                const float v_321 = (v_302 * v_303) + ((v_304 * v_305) + (q_4_4 + ((v_306 * v_307) + ((v_308 * v_309) +
                    v_320))));
                const float d_4_2 = (v_292 * v_293) + ((v_294 * v_295) + ((v_296 * v_297) + ((v_298 * v_299) + ((v_300 *
                    v_301) + v_321))));
                const float per_d_4 = 1.0f / ((d_4_2 >= 1.0e-30f) ? d_4_2 : 1.0f);
                const float u_3_11 = before->factors[41];
                const float v_322 = ((u_3_11 + (f_3_6 * u_6_11)) + (f_3_8 * u_8_11)) + (f_3_10 * u_10_11);
                const float u_3_11_2 = per_d_11 * (d_11 * v_322);
                const float v_323 = -u_3_11_2;
                const float u_3_10 = before->factors[40];
                const float v_324 = f_3_10 + ((u_3_10 + (f_3_6 * u_6_10)) + (f_3_8 * u_8_10));
                const float v_325 = v_322 - u_3_11_2;
                const float u_3_10_2 = per_d_10 * ((v_323 * v_24) + ((d_10 * v_324) + (v_325 * v_26)));
                const float v_326 = -u_3_10_2;
                const float v_327 = v_323 - (v_23 * u_3_10_2);
                const float v_328 = v_325 - (v_25 * u_3_10_2);
                const float v_329 = v_324 - u_3_10_2;
                const float u_3_9 = before->factors[39];
                const float v_330 = (u_3_9 + (f_3_6 * u_6_9)) + (f_3_8 * u_8_9);
                const float u_3_7 = before->factors[37];
                const float v_331 = u_3_7 + (f_3_6 * u_6_7);
                const float u_3_8 = before->factors[38];
                const float v_332 = f_3_8 + (u_3_8 + (f_3_6 * u_6_8));
                const float v_333 = (v_328 * v_36) + ((v_329 * v_38) + ((v_330 * v_40) + ((v_331 * v_41) + (v_332 *
                    v_43))));
                const float u_3_9_2 = per_d_9 * ((v_326 * v_32) + ((v_327 * v_34) + v_333));
                const float v_334 = -u_3_9_2;
                const float v_335 = v_326 - (v_31 * u_3_9_2);
                const float v_336 = v_327 - (v_33 * u_3_9_2);
                const float v_337 = v_328 - (v_35 * u_3_9_2);
                const float v_338 = v_329 - (v_37 * u_3_9_2);
                const float v_339 = v_330 - (v_39 * u_3_9_2);
                const float v_340 = v_331 - (f_9_7 * u_3_9_2);
                const float v_341 = v_332 - (v_42 * u_3_9_2);
                const float v_342 = (v_337 * v_64) + ((v_338 * v_66) + ((v_339 * v_70) + ((v_340 * v_58) + (v_341 *
                    v_68))));
                const float u_3_8_2 = per_d_8 * ((v_334 * v_56) + ((v_335 * v_60) + ((v_336 * v_62) + v_342)));
                const float v_343 = -u_3_8_2;
                const float v_344 = v_334 - (v_55 * u_3_8_2);
                const float v_345 = v_335 - (v_59 * u_3_8_2);
                const float v_346 = v_336 - (v_61 * u_3_8_2);
                const float v_347 = v_337 - (v_63 * u_3_8_2);
                const float v_348 = v_338 - (v_65 * u_3_8_2);
                const float v_349 = v_339 - (v_69 * u_3_8_2);
                const float v_350 = v_340 - (v_57 * u_3_8_2);
                const float v_351 = v_341 - (v_67 * u_3_8_2);
                const float v_352 = (v_347 * v_100) + ((v_348 * v_102) + ((v_349 * v_104) + ((v_350 * v_106) + (v_351 *
                    v_108))));
                const float u_3_7_2 = per_d_7 * ((v_343 * v_92) + ((v_344 * v_94) + ((v_345 * v_96) + ((v_346 * v_98) +
                    v_352))));
                const float v_353 = -u_3_7_2;
                const float v_354 = v_343 - (v_91 * u_3_7_2);
                const float v_355 = v_344 - (v_93 * u_3_7_2);
                const float v_356 = v_345 - (v_95 * u_3_7_2);
                const float v_357 = v_346 - (v_97 * u_3_7_2);
                const float v_358 = v_347 - (v_99 * u_3_7_2);
                const float v_359 = v_348 - (v_101 * u_3_7_2);
                const float v_360 = v_349 - (v_103 * u_3_7_2);
                const float v_361 = v_351 - (v_107 * u_3_7_2);
                const float u_3_6 = before->factors[36];
                const float v_362 = f_3_6 + u_3_6;
                const float v_363 = v_350 - (v_105 * u_3_7_2);
                const float v_364 = (v_359 * v_154) + ((v_360 * v_156) + ((v_361 * v_158) + ((d_6 * v_362) + (v_363 *
                    v_160))));
                const float v_365 = (v_354 * v_144) + ((v_355 * v_146) + ((v_356 * v_148) + ((v_357 * v_150) + ((v_358 *
                    v_152) + v_364))));
                const float u_3_6_2 = per_d_6 * ((v_353 * v_142) + v_365);
                const float v_366 = -u_3_6_2;
                const float v_367 = v_353 - (v_141 * u_3_6_2);
                const float v_368 = v_354 - (v_143 * u_3_6_2);
                const float v_369 = v_355 - (v_145 * u_3_6_2);
                const float v_370 = v_356 - (v_147 * u_3_6_2);
                const float v_371 = v_357 - (v_149 * u_3_6_2);
                const float v_372 = v_358 - (v_151 * u_3_6_2);
                const float v_373 = v_359 - (v_153 * u_3_6_2);
                const float v_374 = v_360 - (v_155 * u_3_6_2);
                const float v_375 = v_361 - (v_157 * u_3_6_2);
                const float v_376 = v_363 - (v_159 * u_3_6_2);
                const float u_3_5 = before->factors[35];
                const float v_377 = v_362 - u_3_6_2;
                const float v_378 = (v_374 * v_224) + ((v_375 * v_226) + ((v_376 * v_228) + ((u_3_5 * d_5) + (v_377 *
                    v_230))));
                const float v_379 = (v_369 * v_214) + ((v_370 * v_216) + ((v_371 * v_218) + ((v_372 * v_220) + ((v_373 *
                    v_222) + v_378))));
                const float u_3_5_2 = per_d_5 * ((v_366 * v_208) + ((v_367 * v_210) + ((v_368 * v_212) + v_379)));
                const float v_380 = -u_3_5_2;
                const float v_381 = v_366 - (v_207 * u_3_5_2);
                const float v_382 = v_367 - (v_209 * u_3_5_2);
                const float v_383 = v_368 - (v_211 * u_3_5_2);
                const float v_384 = v_369 - (v_213 * u_3_5_2);
                const float v_385 = v_370 - (v_215 * u_3_5_2);
                const float v_386 = v_371 - (v_217 * u_3_5_2);
                const float v_387 = v_372 - (v_219 * u_3_5_2);
                const float v_388 = v_373 - (v_221 * u_3_5_2);
                const float v_389 = v_374 - (v_223 * u_3_5_2);
                const float v_390 = v_375 - (v_225 * u_3_5_2);
                const float v_391 = v_376 - (v_227 * u_3_5_2);
                const float v_392 = v_377 - (v_229 * u_3_5_2);
                const float u_3_4 = before->factors[34];
                const float v_393 = u_3_5 - u_3_5_2;
                const float v_394 = (v_390 * v_313) + ((v_391 * v_315) + ((v_392 * v_317) + ((u_3_4 * d_4) + (v_393 *
                    v_319))));
                const float v_395 = (v_385 * v_303) + ((v_386 * v_305) + ((v_387 * v_307) + ((v_388 * v_309) + ((v_389 *
                    v_311) + v_394))));
                const float v_396 = (v_380 * v_293) + ((v_381 * v_295) + ((v_382 * v_297) + ((v_383 * v_299) + ((v_384 *
                    v_301) + v_395))));
                const float u_3_4_2 = per_d_4 * v_396;
                const float v_397 = -u_3_4_2;
                const float v_398 = q_4_4 * v_397;
                const float v_399 = v_380 - (v_292 * u_3_4_2);
                const float v_400 = q_5_5 * v_399;
                const float v_401 = v_381 - (v_294 * u_3_4_2);
                const float v_402 = q_6_6 * v_401;
                const float v_403 = v_382 - (v_296 * u_3_4_2);
                const float v_404 = q_7_7 * v_403;
                const float v_405 = v_383 - (v_298 * u_3_4_2);
                const float v_406 = q_8_8 * v_405;
                const float v_407 = v_384 - (v_300 * u_3_4_2);
                const float v_408 = q_9_9 * v_407;
                const float v_409 = v_385 - (v_302 * u_3_4_2);
                const float v_410 = q_10_10 * v_409;
                const float v_411 = v_386 - (v_304 * u_3_4_2);
                const float v_412 = q_11_11 * v_411;
                const float q_3_3 = params->variance_step_vy;
                const float v_413 = v_387 - (v_306 * u_3_4_2);
                const float v_414 = d_11 * v_413;
                const float v_415 = v_388 - (v_308 * u_3_4_2);
                const float v_416 = d_10 * v_415;
                const float v_417 = v_389 - (v_310 * u_3_4_2);
                const float v_418 = d_9 * v_417;
                const float v_419 = v_390 - (v_312 * u_3_4_2);
                const float v_420 = d_8 * v_419;
                const float v_421 = v_391 - (v_314 * u_3_4_2);
                const float v_422 = d_7 * v_421;
                const float v_423 = v_392 - (v_316 * u_3_4_2);
                const float v_424 = d_6 * v_423;
                const float v_425 = v_393 - (v_318 * u_3_4_2);
                const float v_426 = d_5 * v_425;
                const float d_3 = before->factors[33];
                const float v_427 = u_3_4 - u_3_4_2;
                const float v_428 = d_4 * v_427;
                const float v_429 = (v_419 * v_420) + ((v_421 * v_422) + ((v_423 * v_424) + ((v_425 * v_426) + (d_3 +
                    (v_427 * v_428)))));
                const float v_430 = (v_411 * v_412) + (q_3_3 + ((v_413 * v_414) + ((v_415 * v_416) + ((v_417 * v_418) +
                    v_429))));
                const float v_431 = (v_401 * v_402) + ((v_403 * v_404) + ((v_405 * v_406) + ((v_407 * v_408) + ((v_409 *
                    v_410) + v_430))));
                const float d_3_2 = (v_397 * v_398) + ((v_399 * v_400) + v_431);
                const float per_d_3 = 1.0f / ((d_3_2 >= 1.0e-30f) ? d_3_2 : 1.0f);
                const float v_432 = before->factors[32] + (0.025f * u_3_11);
                const float u_2_11 = per_d_11 * (d_11 * v_432);
                const float v_433 = -u_2_11;
                const float v_434 = before->factors[31] + (0.025f * u_3_10);
                const float v_435 = v_432 - u_2_11;
                const float u_2_10 = per_d_10 * ((v_433 * v_24) + ((d_10 * v_434) + (v_435 * v_26)));
                const float v_436 = -u_2_10;
                const float v_437 = v_433 - (v_23 * u_2_10);
                const float v_438 = v_435 - (v_25 * u_2_10);
                const float v_439 = v_434 - u_2_10;
                const float v_440 = before->factors[30] + (0.025f * u_3_9);
                const float v_441 = before->factors[28] + (0.025f * u_3_7);
                const float v_442 = before->factors[29] + (0.025f * u_3_8);
                const float v_443 = (v_438 * v_36) + ((v_439 * v_38) + ((v_440 * v_40) + ((v_441 * v_41) + (v_442 *
                    v_43))));
                const float u_2_9 = per_d_9 * ((v_436 * v_32) + ((v_437 * v_34) + v_443));
                const float v_444 = -u_2_9;
                const float v_445 = v_436 - (v_31 * u_2_9);
                const float v_446 = v_437 - (v_33 * u_2_9);
                const float v_447 = v_438 - (v_35 * u_2_9);
                const float v_448 = v_439 - (v_37 * u_2_9);
                const float v_449 = v_440 - (v_39 * u_2_9);
                const float v_450 = v_441 - (f_9_7 * u_2_9);
                const float v_451 = v_442 - (v_42 * u_2_9);
                const float v_452 = (v_447 * v_64) + ((v_448 * v_66) + ((v_449 * v_70) + ((v_450 * v_58) + (v_451 *
                    v_68))));
                const float u_2_8 = per_d_8 * ((v_444 * v_56) + ((v_445 * v_60) + ((v_446 * v_62) + v_452)));
                const float v_453 = -u_2_8;
                const float v_454 = v_444 - (v_55 * u_2_8);
                const float v_455 = v_445 - (v_59 * u_2_8);
                const float v_456 = v_446 - (v_61 * u_2_8);
                const float v_457 = v_447 - (v_63 * u_2_8);
                const float v_458 = v_448 - (v_65 * u_2_8);
                const float v_459 = v_449 - (v_69 * u_2_8);
                const float v_460 = v_450 - (v_57 * u_2_8);
                const float v_461 = v_451 - (v_67 * u_2_8);
                const float v_462 = (v_457 * v_100) + ((v_458 * v_102) + ((v_459 * v_104) + ((v_460 * v_106) + (v_461 *
                    v_108))));
                const float u_2_7 = per_d_7 * ((v_453 * v_92) + ((v_454 * v_94) + ((v_455 * v_96) + ((v_456 * v_98) +
                    v_462))));
                const float v_463 = -u_2_7;
                const float v_464 = v_453 - (v_91 * u_2_7);
                const float v_465 = v_454 - (v_93 * u_2_7);
                const float v_466 = v_455 - (v_95 * u_2_7);
                const float v_467 = v_456 - (v_97 * u_2_7);
                const float v_468 = v_457 - (v_99 * u_2_7);
                const float v_469 = v_458 - (v_101 * u_2_7);
                const float v_470 = v_459 - (v_103 * u_2_7);
                const float v_471 = v_461 - (v_107 * u_2_7);
                const float v_472 = before->factors[27] + (0.025f * u_3_6);
                const float v_473 = v_460 - (v_105 * u_2_7);
                const float v_474 = (v_469 * v_154) + ((v_470 * v_156) + ((v_471 * v_158) + ((d_6 * v_472) + (v_473 *
                    v_160))));
                const float v_475 = (v_464 * v_144) + ((v_465 * v_146) + ((v_466 * v_148) + ((v_467 * v_150) + ((v_468 *
                    v_152) + v_474))));
                const float u_2_6 = per_d_6 * ((v_463 * v_142) + v_475);
                const float v_476 = -u_2_6;
                const float v_477 = v_463 - (v_141 * u_2_6);
                const float v_478 = v_464 - (v_143 * u_2_6);
                const float v_479 = v_465 - (v_145 * u_2_6);
                const float v_480 = v_466 - (v_147 * u_2_6);
                const float v_481 = v_467 - (v_149 * u_2_6);
                const float v_482 = v_468 - (v_151 * u_2_6);
                const float v_483 = v_469 - (v_153 * u_2_6);
                const float v_484 = v_470 - (v_155 * u_2_6);
                const float v_485 = v_471 - (v_157 * u_2_6);
                const float v_486 = v_473 - (v_159 * u_2_6);
                const float v_487 = before->factors[26] + (0.025f * u_3_5);
                const float v_488 = v_472 - u_2_6;
                const float v_489 = (v_484 * v_224) + ((v_485 * v_226) + ((v_486 * v_228) + ((d_5 * v_487) + (v_488 *
                    v_230))));
                const float v_490 = (v_479 * v_214) + ((v_480 * v_216) + ((v_481 * v_218) + ((v_482 * v_220) + ((v_483 *
                    v_222) + v_489))));
                const float u_2_5 = per_d_5 * ((v_476 * v_208) + ((v_477 * v_210) + ((v_478 * v_212) + v_490)));
                const float v_491 = -u_2_5;
                const float v_492 = v_476 - (v_207 * u_2_5);
                const float v_493 = v_477 - (v_209 * u_2_5);
                const float v_494 = v_478 - (v_211 * u_2_5);
                const float v_495 = v_479 - (v_213 * u_2_5);
                const float v_496 = v_480 - (v_215 * u_2_5);
                const float v_497 = v_481 - (v_217 * u_2_5);
                const float v_498 = v_482 - (v_219 * u_2_5);
                const float v_499 = v_483 - (v_221 * u_2_5);
                const float v_500 = v_484 - (v_223 * u_2_5);
                const float v_501 = v_485 - (v_225 * u_2_5);
                const float v_502 = v_486 - (v_227 * u_2_5);
                const float v_503 = v_488 - (v_229 * u_2_5);
                const float v_504 = before->factors[25] + (0.025f * u_3_4);
                const float v_505 = v_487 - u_2_5;
                const float v_506 = (v_501 * v_313) + ((v_502 * v_315) + ((v_503 * v_317) + ((d_4 * v_504) + (v_505 *
                    v_319))));
                const float v_507 = (v_496 * v_303) + ((v_497 * v_305) + ((v_498 * v_307) + ((v_499 * v_309) + ((v_500 *
                    v_311) + v_506))));
                const float v_508 = (v_491 * v_293) + ((v_492 * v_295) + ((v_493 * v_297) + ((v_494 * v_299) + ((v_495 *
                    v_301) + v_507))));
                const float u_2_4 = per_d_4 * v_508;
                const float v_509 = -u_2_4;
                const float v_510 = v_491 - (v_292 * u_2_4);
                const float v_511 = v_492 - (v_294 * u_2_4);
                const float v_512 = v_493 - (v_296 * u_2_4);
                const float v_513 = v_494 - (v_298 * u_2_4);
                const float v_514 = v_495 - (v_300 * u_2_4);
                const float v_515 = v_496 - (v_302 * u_2_4);
                const float v_516 = v_497 - (v_304 * u_2_4);
                const float v_517 = v_498 - (v_306 * u_2_4);
                const float v_518 = v_499 - (v_308 * u_2_4);
                const float v_519 = v_500 - (v_310 * u_2_4);
                const float v_520 = v_501 - (v_312 * u_2_4);
                const float v_521 = v_502 - (v_314 * u_2_4);
                const float v_522 = v_503 - (v_316 * u_2_4);
                const float v_523 = v_505 - (v_318 * u_2_4);
                const float v_524 = 0.025f + before->factors[24];
                const float v_525 = v_504 - u_2_4;
                const float v_526 = (v_521 * v_422) + ((v_522 * v_424) + ((v_523 * v_426) + ((d_3 * v_524) + (v_525 *
                    v_428))));
                const float v_527 = (v_516 * v_412) + ((v_517 * v_414) + ((v_518 * v_416) + ((v_519 * v_418) + ((v_520 *
                    v_420) + v_526))));
                const float v_528 = (v_511 * v_402) + ((v_512 * v_404) + ((v_513 * v_406) + ((v_514 * v_408) + ((v_515 *
                    v_410) + v_527))));
                const float u_2_3 = per_d_3 * ((v_509 * v_398) + ((v_510 * v_400) + v_528));
                const float v_529 = -u_2_3;
                const float v_530 = q_3_3 * v_529;
                const float v_531 = v_509 - (v_397 * u_2_3);
                const float v_532 = q_4_4 * v_531;
                const float v_533 = v_510 - (v_399 * u_2_3);
                const float v_534 = q_5_5 * v_533;
                const float v_535 = v_511 - (v_401 * u_2_3);
                const float v_536 = q_6_6 * v_535;
                const float v_537 = v_512 - (v_403 * u_2_3);
                const float v_538 = q_7_7 * v_537;
                const float v_539 = v_513 - (v_405 * u_2_3);
                const float v_540 = q_8_8 * v_539;
                const float v_541 = v_514 - (v_407 * u_2_3);
                const float v_542 = q_9_9 * v_541;
                const float v_543 = v_515 - (v_409 * u_2_3);
                const float v_544 = q_10_10 * v_543;
                const float v_545 = v_516 - (v_411 * u_2_3);
                const float v_546 = q_11_11 * v_545;
                const float q_2_2 = params->variance_step_y;
                const float v_547 = v_517 - (v_413 * u_2_3);
                const float v_548 = d_11 * v_547;
                const float v_549 = v_518 - (v_415 * u_2_3);
                const float v_550 = d_10 * v_549;
                const float v_551 = v_519 - (v_417 * u_2_3);
                const float v_552 = d_9 * v_551;
                const float v_553 = v_520 - (v_419 * u_2_3);
                const float v_554 = d_8 * v_553;
                const float v_555 = v_521 - (v_421 * u_2_3);
                const float v_556 = d_7 * v_555;
                const float v_557 = v_522 - (v_423 * u_2_3);
                const float v_558 = d_6 * v_557;
                const float v_559 = v_523 - (v_425 * u_2_3);
                const float v_560 = d_5 * v_559;
                const float v_561 = v_525 - (v_427 * u_2_3);
                const float v_562 = d_4 * v_561;
                const float d_2 = before->factors[23];
                const float v_563 = v_524 - u_2_3;
                const float v_564 = d_3 * v_563;
                const float v_565 = (v_555 * v_556) + ((v_557 * v_558) + ((v_559 * v_560) + ((v_561 * v_562) + (d_2 +
                    (v_563 * v_564)))));
                const float v_566 = q_2_2 + ((v_547 * v_548) + ((v_549 * v_550) + ((v_551 * v_552) + ((v_553 * v_554) +
                    v_565))));
                const float v_567 = (v_537 * v_538) + ((v_539 * v_540) + ((v_541 * v_542) + ((v_543 * v_544) + ((v_545 *
                    v_546) + v_566))));
                const float d_2_2 = (v_529 * v_530) + ((v_531 * v_532) + ((v_533 * v_534) + ((v_535 * v_536) + v_567)));
                const float per_d_2 = 1.0f / ((d_2_2 >= 1.0e-30f) ? d_2_2 : 1.0f);
                const float u_1_11 = before->factors[22];
                const float v_568 = ((u_1_11 + (f_1_6 * u_6_11)) + (f_1_8 * u_8_11)) + (f_1_10 * u_10_11);
                const float u_1_11_2 = per_d_11 * (d_11 * v_568);
                const float v_569 = -u_1_11_2;
                const float u_1_10 = before->factors[21];
                const float v_570 = f_1_10 + ((u_1_10 + (f_1_6 * u_6_10)) + (f_1_8 * u_8_10));
                const float v_571 = v_568 - u_1_11_2;
                const float u_1_10_2 = per_d_10 * ((v_569 * v_24) + ((d_10 * v_570) + (v_571 * v_26)));
                const float v_572 = -u_1_10_2;
                const float v_573 = v_569 - (v_23 * u_1_10_2);
                const float v_574 = v_571 - (v_25 * u_1_10_2);
                const float v_575 = v_570 - u_1_10_2;
                const float u_1_9 = before->factors[20];
                const float v_576 = (u_1_9 + (f_1_6 * u_6_9)) + (f_1_8 * u_8_9);
                const float u_1_7 = before->factors[18];
                const float v_577 = u_1_7 + (f_1_6 * u_6_7);
                const float u_1_8 = before->factors[19];
                const float v_578 = f_1_8 + (u_1_8 + (f_1_6 * u_6_8));
                const float v_579 = (v_574 * v_36) + ((v_575 * v_38) + ((v_576 * v_40) + ((v_577 * v_41) + (v_578 *
                    v_43))));
                const float u_1_9_2 = per_d_9 * ((v_572 * v_32) + ((v_573 * v_34) + v_579));
                const float v_580 = -u_1_9_2;
                const float v_581 = v_572 - (v_31 * u_1_9_2);
                const float v_582 = v_573 - (v_33 * u_1_9_2);
                const float v_583 = v_574 - (v_35 * u_1_9_2);
                const float v_584 = v_575 - (v_37 * u_1_9_2);
                const float v_585 = v_576 - (v_39 * u_1_9_2);
                const float v_586 = v_577 - (f_9_7 * u_1_9_2);
                const float v_587 = v_578 - (v_42 * u_1_9_2);
                const float v_588 = (v_583 * v_64) + ((v_584 * v_66) + ((v_585 * v_70) + ((v_586 * v_58) + (v_587 *
                    v_68))));
                const float u_1_8_2 = per_d_8 * ((v_580 * v_56) + ((v_581 * v_60) + ((v_582 * v_62) + v_588)));
                const float v_589 = -u_1_8_2;
                const float v_590 = v_580 - (v_55 * u_1_8_2);
                const float v_591 = v_581 - (v_59 * u_1_8_2);
                const float v_592 = v_582 - (v_61 * u_1_8_2);
                const float v_593 = v_583 - (v_63 * u_1_8_2);
                const float v_594 = v_584 - (v_65 * u_1_8_2);
                const float v_595 = v_585 - (v_69 * u_1_8_2);
                const float v_596 = v_586 - (v_57 * u_1_8_2);
                const float v_597 = v_587 - (v_67 * u_1_8_2);
                const float v_598 = (v_593 * v_100) + ((v_594 * v_102) + ((v_595 * v_104) + ((v_596 * v_106) + (v_597 *
                    v_108))));
                const float u_1_7_2 = per_d_7 * ((v_589 * v_92) + ((v_590 * v_94) + ((v_591 * v_96) + ((v_592 * v_98) +
                    v_598))));
                const float v_599 = -u_1_7_2;
                const float v_600 = v_589 - (v_91 * u_1_7_2);
                const float v_601 = v_590 - (v_93 * u_1_7_2);
                const float v_602 = v_591 - (v_95 * u_1_7_2);
                const float v_603 = v_592 - (v_97 * u_1_7_2);
                const float v_604 = v_593 - (v_99 * u_1_7_2);
                const float v_605 = v_594 - (v_101 * u_1_7_2);
                const float v_606 = v_595 - (v_103 * u_1_7_2);
                const float v_607 = v_597 - (v_107 * u_1_7_2);
                const float u_1_6 = before->factors[17];
                const float v_608 = f_1_6 + u_1_6;
                const float v_609 = v_596 - (v_105 * u_1_7_2);
                const float v_610 = (v_605 * v_154) + ((v_606 * v_156) + ((v_607 * v_158) + ((d_6 * v_608) + (v_609 *
                    v_160))));
                const float v_611 = (v_600 * v_144) + ((v_601 * v_146) + ((v_602 * v_148) + ((v_603 * v_150) + ((v_604 *
                    v_152) + v_610))));
                const float u_1_6_2 = per_d_6 * ((v_599 * v_142) + v_611);
                const float v_612 = -u_1_6_2;
                const float v_613 = v_599 - (v_141 * u_1_6_2);
                const float v_614 = v_600 - (v_143 * u_1_6_2);
                const float v_615 = v_601 - (v_145 * u_1_6_2);
                const float v_616 = v_602 - (v_147 * u_1_6_2);
                const float v_617 = v_603 - (v_149 * u_1_6_2);
                const float v_618 = v_604 - (v_151 * u_1_6_2);
                const float v_619 = v_605 - (v_153 * u_1_6_2);
                const float v_620 = v_606 - (v_155 * u_1_6_2);
                const float v_621 = v_607 - (v_157 * u_1_6_2);
                const float v_622 = v_609 - (v_159 * u_1_6_2);
                const float u_1_5 = before->factors[16];
                const float v_623 = v_608 - u_1_6_2;
                const float v_624 = (v_620 * v_224) + ((v_621 * v_226) + ((v_622 * v_228) + ((u_1_5 * d_5) + (v_623 *
                    v_230))));
                const float v_625 = (v_615 * v_214) + ((v_616 * v_216) + ((v_617 * v_218) + ((v_618 * v_220) + ((v_619 *
                    v_222) + v_624))));
                const float u_1_5_2 = per_d_5 * ((v_612 * v_208) + ((v_613 * v_210) + ((v_614 * v_212) + v_625)));
                const float v_626 = -u_1_5_2;
                const float v_627 = v_612 - (v_207 * u_1_5_2);
                const float v_628 = v_613 - (v_209 * u_1_5_2);
                const float v_629 = v_614 - (v_211 * u_1_5_2);
                const float v_630 = v_615 - (v_213 * u_1_5_2);
                const float v_631 = v_616 - (v_215 * u_1_5_2);
                const float v_632 = v_617 - (v_217 * u_1_5_2);
                const float v_633 = v_618 - (v_219 * u_1_5_2);
                const float v_634 = v_619 - (v_221 * u_1_5_2);
                const float v_635 = v_620 - (v_223 * u_1_5_2);
                const float v_636 = v_621 - (v_225 * u_1_5_2);
                const float v_637 = v_622 - (v_227 * u_1_5_2);
                const float v_638 = v_623 - (v_229 * u_1_5_2);
                const float u_1_4 = before->factors[15];
                const float v_639 = u_1_5 - u_1_5_2;
                const float v_640 = (v_636 * v_313) + ((v_637 * v_315) + ((v_638 * v_317) + ((u_1_4 * d_4) + (v_639 *
                    v_319))));
                const float v_641 = (v_631 * v_303) + ((v_632 * v_305) + ((v_633 * v_307) + ((v_634 * v_309) + ((v_635 *
                    v_311) + v_640))));
                const float v_642 = (v_626 * v_293) + ((v_627 * v_295) + ((v_628 * v_297) + ((v_629 * v_299) + ((v_630 *
                    v_301) + v_641))));
                const float u_1_4_2 = per_d_4 * v_642;
                const float v_643 = -u_1_4_2;
                const float v_644 = v_626 - (v_292 * u_1_4_2);
                const float v_645 = v_627 - (v_294 * u_1_4_2);
                const float v_646 = v_628 - (v_296 * u_1_4_2);
                const float v_647 = v_629 - (v_298 * u_1_4_2);
                const float v_648 = v_630 - (v_300 * u_1_4_2);
                const float v_649 = v_631 - (v_302 * u_1_4_2);
                const float v_650 = v_632 - (v_304 * u_1_4_2);
                const float v_651 = v_633 - (v_306 * u_1_4_2);
                const float v_652 = v_634 - (v_308 * u_1_4_2);
                const float v_653 = v_635 - (v_310 * u_1_4_2);
                const float v_654 = v_636 - (v_312 * u_1_4_2);
                const float v_655 = v_637 - (v_314 * u_1_4_2);
                const float v_656 = v_638 - (v_316 * u_1_4_2);
                const float v_657 = v_639 - (v_318 * u_1_4_2);
                const float u_1_3 = before->factors[14];
                const float v_658 = u_1_4 - u_1_4_2;
                const float v_659 = (v_655 * v_422) + ((v_656 * v_424) + ((v_657 * v_426) + ((u_1_3 * d_3) + (v_658 *
                    v_428))));
                const float v_660 = (v_650 * v_412) + ((v_651 * v_414) + ((v_652 * v_416) + ((v_653 * v_418) + ((v_654 *
                    v_420) + v_659))));
                const float v_661 = (v_645 * v_402) + ((v_646 * v_404) + ((v_647 * v_406) + ((v_648 * v_408) + ((v_649 *
                    v_410) + v_660))));
                const float u_1_3_2 = per_d_3 * ((v_643 * v_398) + ((v_644 * v_400) + v_661));
                const float v_662 = -u_1_3_2;
                const float v_663 = v_643 - (v_397 * u_1_3_2);
                const float v_664 = v_644 - (v_399 * u_1_3_2);
                const float v_665 = v_645 - (v_401 * u_1_3_2);
                const float v_666 = v_646 - (v_403 * u_1_3_2);
                const float v_667 = v_647 - (v_405 * u_1_3_2);
                const float v_668 = v_648 - (v_407 * u_1_3_2);
                const float v_669 = v_649 - (v_409 * u_1_3_2);
                const float v_670 = v_650 - (v_411 * u_1_3_2);
                const float v_671 = v_651 - (v_413 * u_1_3_2);
                const float v_672 = v_652 - (v_415 * u_1_3_2);
                const float v_673 = v_653 - (v_417 * u_1_3_2);
                const float v_674 = v_654 - (v_419 * u_1_3_2);
                const float v_675 = v_655 - (v_421 * u_1_3_2);
                const float v_676 = v_656 - (v_423 * u_1_3_2);
                const float v_677 = v_657 - (v_425 * u_1_3_2);
                const float v_678 = v_658 - (v_427 * u_1_3_2);
                const float u_1_2 = before->factors[13];
                const float v_679 = u_1_3 - u_1_3_2;
                const float v_680 = (v_676 * v_558) + ((v_677 * v_560) + ((v_678 * v_562) + ((u_1_2 * d_2) + (v_679 *
                    v_564))));
                const float v_681 = (v_671 * v_548) + ((v_672 * v_550) + ((v_673 * v_552) + ((v_674 * v_554) + ((v_675 *
                    v_556) + v_680))));
                const float v_682 = (v_666 * v_538) + ((v_667 * v_540) + ((v_668 * v_542) + ((v_669 * v_544) + ((v_670 *
                    v_546) + v_681))));
                const float u_1_2_2 = per_d_2 * ((v_662 * v_530) + ((v_663 * v_532) + ((v_664 * v_534) + ((v_665 *
                    v_536) + v_682))));
                const float v_683 = -u_1_2_2;
                const float v_684 = q_2_2 * v_683;
                const float v_685 = v_662 - (v_529 * u_1_2_2);
                const float v_686 = q_3_3 * v_685;
                const float v_687 = v_663 - (v_531 * u_1_2_2);
                const float v_688 = q_4_4 * v_687;
                const float v_689 = v_664 - (v_533 * u_1_2_2);
                const float v_690 = q_5_5 * v_689;
                const float v_691 = v_665 - (v_535 * u_1_2_2);
                const float v_692 = q_6_6 * v_691;
                const float v_693 = v_666 - (v_537 * u_1_2_2);
                const float v_694 = q_7_7 * v_693;
                const float v_695 = v_667 - (v_539 * u_1_2_2);
                const float v_696 = q_8_8 * v_695;
                const float v_697 = v_668 - (v_541 * u_1_2_2);
                const float v_698 = q_9_9 * v_697;
                const float v_699 = v_669 - (v_543 * u_1_2_2);
                const float v_700 = q_10_10 * v_699;
                const float v_701 = v_670 - (v_545 * u_1_2_2);
                const float v_702 = q_11_11 * v_701;
                const float q_1_1 = params->variance_step_vx;
                const float v_703 = v_671 - (v_547 * u_1_2_2);
                const float v_704 = d_11 * v_703;
                const float v_705 = v_672 - (v_549 * u_1_2_2);
                const float v_706 = d_10 * v_705;
                const float v_707 = v_673 - (v_551 * u_1_2_2);
                const float v_708 = d_9 * v_707;
                const float v_709 = v_674 - (v_553 * u_1_2_2);
                const float v_710 = d_8 * v_709;
                const float v_711 = v_675 - (v_555 * u_1_2_2);
                const float v_712 = d_7 * v_711;
                const float v_713 = v_676 - (v_557 * u_1_2_2);
                const float v_714 = d_6 * v_713;
                const float v_715 = v_677 - (v_559 * u_1_2_2);
                const float v_716 = d_5 * v_715;
                const float v_717 = v_678 - (v_561 * u_1_2_2);
                const float v_718 = d_4 * v_717;
                const float v_719 = v_679 - (v_563 * u_1_2_2);
                const float v_720 = d_3 * v_719;
                const float d_1 = before->factors[12];
                const float v_721 = u_1_2 - u_1_2_2;
                const float v_722 = d_2 * v_721;
                const float v_723 = (v_713 * v_714) + ((v_715 * v_716) + ((v_717 * v_718) + ((v_719 * v_720) + (d_1 +
                    (v_721 * v_722)))));
                const float v_724 = (v_703 * v_704) + ((v_705 * v_706) + ((v_707 * v_708) + ((v_709 * v_710) + ((v_711 *
                    v_712) + v_723))));
                const float v_725 = (v_695 * v_696) + ((v_697 * v_698) + ((v_699 * v_700) + ((v_701 * v_702) + (q_1_1 +
                    v_724))));
                const float v_726 = (v_685 * v_686) + ((v_687 * v_688) + ((v_689 * v_690) + ((v_691 * v_692) + ((v_693 *
                    v_694) + v_725))));
                const float d_1_2 = (v_683 * v_684) + v_726;
                const float per_d_1 = 1.0f / ((d_1_2 >= 1.0e-30f) ? d_1_2 : 1.0f);
                const float v_727 = before->factors[11] + (0.025f * u_1_11);
                const float u_0_11 = per_d_11 * (d_11 * v_727);
                const float v_728 = -u_0_11;
                const float v_729 = before->factors[10] + (0.025f * u_1_10);
                const float v_730 = v_727 - u_0_11;
                const float u_0_10 = per_d_10 * ((v_728 * v_24) + ((d_10 * v_729) + (v_730 * v_26)));
                const float v_731 = -u_0_10;
                const float v_732 = v_728 - (v_23 * u_0_10);
                const float v_733 = v_730 - (v_25 * u_0_10);
                const float v_734 = v_729 - u_0_10;
                const float v_735 = before->factors[9] + (0.025f * u_1_9);
                const float v_736 = before->factors[7] + (0.025f * u_1_7);
                const float v_737 = before->factors[8] + (0.025f * u_1_8);
                const float v_738 = (v_733 * v_36) + ((v_734 * v_38) + ((v_735 * v_40) + ((v_736 * v_41) + (v_737 *
                    v_43))));
                const float u_0_9 = per_d_9 * ((v_731 * v_32) + ((v_732 * v_34) + v_738));
                const float v_739 = -u_0_9;
                const float v_740 = v_731 - (v_31 * u_0_9);
                const float v_741 = v_732 - (v_33 * u_0_9);
                const float v_742 = v_733 - (v_35 * u_0_9);
                const float v_743 = v_734 - (v_37 * u_0_9);
                const float v_744 = v_735 - (v_39 * u_0_9);
                const float v_745 = v_736 - (f_9_7 * u_0_9);
                const float v_746 = v_737 - (v_42 * u_0_9);
                const float v_747 = (v_742 * v_64) + ((v_743 * v_66) + ((v_744 * v_70) + ((v_745 * v_58) + (v_746 *
                    v_68))));
                const float u_0_8 = per_d_8 * ((v_739 * v_56) + ((v_740 * v_60) + ((v_741 * v_62) + v_747)));
                const float v_748 = -u_0_8;
                const float v_749 = v_739 - (v_55 * u_0_8);
                const float v_750 = v_740 - (v_59 * u_0_8);
                const float v_751 = v_741 - (v_61 * u_0_8);
                const float v_752 = v_742 - (v_63 * u_0_8);
                const float v_753 = v_743 - (v_65 * u_0_8);
                const float v_754 = v_744 - (v_69 * u_0_8);
                const float v_755 = v_745 - (v_57 * u_0_8);
                const float v_756 = v_746 - (v_67 * u_0_8);
                const float v_757 = (v_752 * v_100) + ((v_753 * v_102) + ((v_754 * v_104) + ((v_755 * v_106) + (v_756 *
                    v_108))));
                const float u_0_7 = per_d_7 * ((v_748 * v_92) + ((v_749 * v_94) + ((v_750 * v_96) + ((v_751 * v_98) +
                    v_757))));
                const float v_758 = -u_0_7;
                const float v_759 = v_748 - (v_91 * u_0_7);
                const float v_760 = v_749 - (v_93 * u_0_7);
                const float v_761 = v_750 - (v_95 * u_0_7);
                const float v_762 = v_751 - (v_97 * u_0_7);
                const float v_763 = v_752 - (v_99 * u_0_7);
                const float v_764 = v_753 - (v_101 * u_0_7);
                const float v_765 = v_754 - (v_103 * u_0_7);
                const float v_766 = v_756 - (v_107 * u_0_7);
                const float v_767 = before->factors[6] + (0.025f * u_1_6);
                const float v_768 = v_755 - (v_105 * u_0_7);
                const float v_769 = (v_764 * v_154) + ((v_765 * v_156) + ((v_766 * v_158) + ((d_6 * v_767) + (v_768 *
                    v_160))));
                const float v_770 = (v_759 * v_144) + ((v_760 * v_146) + ((v_761 * v_148) + ((v_762 * v_150) + ((v_763 *
                    v_152) + v_769))));
                const float u_0_6 = per_d_6 * ((v_758 * v_142) + v_770);
                const float v_771 = -u_0_6;
                const float v_772 = v_758 - (v_141 * u_0_6);
                const float v_773 = v_759 - (v_143 * u_0_6);
                const float v_774 = v_760 - (v_145 * u_0_6);
                const float v_775 = v_761 - (v_147 * u_0_6);
                const float v_776 = v_762 - (v_149 * u_0_6);
                const float v_777 = v_763 - (v_151 * u_0_6);
                const float v_778 = v_764 - (v_153 * u_0_6);
                const float v_779 = v_765 - (v_155 * u_0_6);
                const float v_780 = v_766 - (v_157 * u_0_6);
                const float v_781 = v_768 - (v_159 * u_0_6);
                const float v_782 = before->factors[5] + (0.025f * u_1_5);
                const float v_783 = v_767 - u_0_6;
                const float v_784 = (v_779 * v_224) + ((v_780 * v_226) + ((v_781 * v_228) + ((d_5 * v_782) + (v_783 *
                    v_230))));
                const float v_785 = (v_774 * v_214) + ((v_775 * v_216) + ((v_776 * v_218) + ((v_777 * v_220) + ((v_778 *
                    v_222) + v_784))));
                const float u_0_5 = per_d_5 * ((v_771 * v_208) + ((v_772 * v_210) + ((v_773 * v_212) + v_785)));
                const float v_786 = -u_0_5;
                const float v_787 = v_771 - (v_207 * u_0_5);
                const float v_788 = v_772 - (v_209 * u_0_5);
                const float v_789 = v_773 - (v_211 * u_0_5);
                const float v_790 = v_774 - (v_213 * u_0_5);
                const float v_791 = v_775 - (v_215 * u_0_5);
                const float v_792 = v_776 - (v_217 * u_0_5);
                const float v_793 = v_777 - (v_219 * u_0_5);
                const float v_794 = v_778 - (v_221 * u_0_5);
                const float v_795 = v_779 - (v_223 * u_0_5);
                const float v_796 = v_780 - (v_225 * u_0_5);
                const float v_797 = v_781 - (v_227 * u_0_5);
                const float v_798 = v_783 - (v_229 * u_0_5);
                const float v_799 = before->factors[4] + (0.025f * u_1_4);
                const float v_800 = v_782 - u_0_5;
                const float v_801 = (v_796 * v_313) + ((v_797 * v_315) + ((v_798 * v_317) + ((d_4 * v_799) + (v_800 *
                    v_319))));
                const float v_802 = (v_791 * v_303) + ((v_792 * v_305) + ((v_793 * v_307) + ((v_794 * v_309) + ((v_795 *
                    v_311) + v_801))));
                const float v_803 = (v_786 * v_293) + ((v_787 * v_295) + ((v_788 * v_297) + ((v_789 * v_299) + ((v_790 *
                    v_301) + v_802))));
                const float u_0_4 = per_d_4 * v_803;
                const float v_804 = -u_0_4;
                const float v_805 = v_786 - (v_292 * u_0_4);
                const float v_806 = v_787 - (v_294 * u_0_4);
                const float v_807 = v_788 - (v_296 * u_0_4);
                const float v_808 = v_789 - (v_298 * u_0_4);
                const float v_809 = v_790 - (v_300 * u_0_4);
                const float v_810 = v_791 - (v_302 * u_0_4);
                const float v_811 = v_792 - (v_304 * u_0_4);
                const float v_812 = v_793 - (v_306 * u_0_4);
                const float v_813 = v_794 - (v_308 * u_0_4);
                const float v_814 = v_795 - (v_310 * u_0_4);
                const float v_815 = v_796 - (v_312 * u_0_4);
                const float v_816 = v_797 - (v_314 * u_0_4);
                const float v_817 = v_798 - (v_316 * u_0_4);
                const float v_818 = v_800 - (v_318 * u_0_4);
                const float v_819 = before->factors[3] + (0.025f * u_1_3);
                const float v_820 = v_799 - u_0_4;
                const float v_821 = (v_816 * v_422) + ((v_817 * v_424) + ((v_818 * v_426) + ((d_3 * v_819) + (v_820 *
                    v_428))));
                const float v_822 = (v_811 * v_412) + ((v_812 * v_414) + ((v_813 * v_416) + ((v_814 * v_418) + ((v_815 *
                    v_420) + v_821))));
                const float v_823 = (v_806 * v_402) + ((v_807 * v_404) + ((v_808 * v_406) + ((v_809 * v_408) + ((v_810 *
                    v_410) + v_822))));
                const float u_0_3 = per_d_3 * ((v_804 * v_398) + ((v_805 * v_400) + v_823));
                const float v_824 = -u_0_3;
                const float v_825 = v_804 - (v_397 * u_0_3);
                const float v_826 = v_805 - (v_399 * u_0_3);
                const float v_827 = v_806 - (v_401 * u_0_3);
                const float v_828 = v_807 - (v_403 * u_0_3);
                const float v_829 = v_808 - (v_405 * u_0_3);
                const float v_830 = v_809 - (v_407 * u_0_3);
                const float v_831 = v_810 - (v_409 * u_0_3);
                const float v_832 = v_811 - (v_411 * u_0_3);
                const float v_833 = v_812 - (v_413 * u_0_3);
                const float v_834 = v_813 - (v_415 * u_0_3);
                const float v_835 = v_814 - (v_417 * u_0_3);
                const float v_836 = v_815 - (v_419 * u_0_3);
                const float v_837 = v_816 - (v_421 * u_0_3);
                const float v_838 = v_817 - (v_423 * u_0_3);
                const float v_839 = v_818 - (v_425 * u_0_3);
                const float v_840 = v_820 - (v_427 * u_0_3);
                const float v_841 = before->factors[2] + (0.025f * u_1_2);
                const float v_842 = v_819 - u_0_3;
                const float v_843 = (v_838 * v_558) + ((v_839 * v_560) + ((v_840 * v_562) + ((d_2 * v_841) + (v_842 *
                    v_564))));
                const float v_844 = (v_833 * v_548) + ((v_834 * v_550) + ((v_835 * v_552) + ((v_836 * v_554) + ((v_837 *
                    v_556) + v_843))));
                const float v_845 = (v_828 * v_538) + ((v_829 * v_540) + ((v_830 * v_542) + ((v_831 * v_544) + ((v_832 *
                    v_546) + v_844))));
                const float u_0_2 = per_d_2 * ((v_824 * v_530) + ((v_825 * v_532) + ((v_826 * v_534) + ((v_827 * v_536)
                    + v_845))));
                const float v_846 = -u_0_2;
                const float v_847 = v_824 - (v_529 * u_0_2);
                const float v_848 = v_825 - (v_531 * u_0_2);
                const float v_849 = v_826 - (v_533 * u_0_2);
                const float v_850 = v_827 - (v_535 * u_0_2);
                const float v_851 = v_828 - (v_537 * u_0_2);
                const float v_852 = v_829 - (v_539 * u_0_2);
                const float v_853 = v_830 - (v_541 * u_0_2);
                const float v_854 = v_831 - (v_543 * u_0_2);
                const float v_855 = v_832 - (v_545 * u_0_2);
                const float v_856 = v_833 - (v_547 * u_0_2);
                const float v_857 = v_834 - (v_549 * u_0_2);
                const float v_858 = v_835 - (v_551 * u_0_2);
                const float v_859 = v_836 - (v_553 * u_0_2);
                const float v_860 = v_837 - (v_555 * u_0_2);
                const float v_861 = v_838 - (v_557 * u_0_2);
                const float v_862 = v_839 - (v_559 * u_0_2);
                const float v_863 = v_840 - (v_561 * u_0_2);
                const float v_864 = v_842 - (v_563 * u_0_2);
                const float v_865 = 0.025f + before->factors[1];
                const float v_866 = v_841 - u_0_2;
                const float v_867 = (v_862 * v_716) + ((v_863 * v_718) + ((v_864 * v_720) + ((d_1 * v_865) + (v_866 *
                    v_722))));
                const float v_868 = (v_857 * v_706) + ((v_858 * v_708) + ((v_859 * v_710) + ((v_860 * v_712) + ((v_861 *
                    v_714) + v_867))));
                const float v_869 = (v_852 * v_696) + ((v_853 * v_698) + ((v_854 * v_700) + ((v_855 * v_702) + ((v_856 *
                    v_704) + v_868))));
                const float v_870 = (v_847 * v_686) + ((v_848 * v_688) + ((v_849 * v_690) + ((v_850 * v_692) + ((v_851 *
                    v_694) + v_869))));
                const float u_0_1 = per_d_1 * ((v_846 * v_684) + v_870);
                const float v_871 = -u_0_1;
                const float v_872 = v_846 - (v_683 * u_0_1);
                const float v_873 = v_847 - (v_685 * u_0_1);
                const float v_874 = v_848 - (v_687 * u_0_1);
                const float v_875 = v_849 - (v_689 * u_0_1);
                const float v_876 = v_850 - (v_691 * u_0_1);
                const float v_877 = v_851 - (v_693 * u_0_1);
                const float v_878 = v_852 - (v_695 * u_0_1);
                const float v_879 = v_853 - (v_697 * u_0_1);
                const float v_880 = v_854 - (v_699 * u_0_1);
                const float v_881 = v_855 - (v_701 * u_0_1);
                const float v_882 = v_856 - (v_703 * u_0_1);
                const float v_883 = v_857 - (v_705 * u_0_1);
                const float v_884 = v_858 - (v_707 * u_0_1);
                const float v_885 = v_859 - (v_709 * u_0_1);
                const float v_886 = v_860 - (v_711 * u_0_1);
                const float v_887 = v_861 - (v_713 * u_0_1);
                const float v_888 = v_862 - (v_715 * u_0_1);
                const float v_889 = v_863 - (v_717 * u_0_1);
                const float v_890 = v_864 - (v_719 * u_0_1);
                const float v_891 = v_866 - (v_721 * u_0_1);
                const float v_892 = v_865 - u_0_1;
                const float v_893 = (v_890 * (d_3 * v_890)) + ((v_891 * (d_2 * v_891)) + (before->factors[0] + (v_892 *
                    (d_1 * v_892))));
                const float v_894 = (v_887 * (d_6 * v_887)) + ((v_888 * (d_5 * v_888)) + ((v_889 * (d_4 * v_889)) +
                    v_893));
                const float v_895 = (v_884 * (d_9 * v_884)) + ((v_885 * (d_8 * v_885)) + ((v_886 * (d_7 * v_886)) +
                    v_894));
                const float v_896 = params->variance_step_x + ((v_882 * (d_11 * v_882)) + ((v_883 * (d_10 * v_883)) +
                    v_895));
                const float v_897 = (v_879 * (q_9_9 * v_879)) + ((v_880 * (q_10_10 * v_880)) + ((v_881 * (q_11_11 *
                    v_881)) + v_896));
                const float v_898 = (v_876 * (q_6_6 * v_876)) + ((v_877 * (q_7_7 * v_877)) + ((v_878 * (q_8_8 * v_878))
                    + v_897));
                const float v_899 = (v_873 * (q_3_3 * v_873)) + ((v_874 * (q_4_4 * v_874)) + ((v_875 * (q_5_5 * v_875))
                    + v_898));
                after->factors[0] = (v_871 * (q_1_1 * v_871)) + ((v_872 * (q_2_2 * v_872)) + v_899);
                after->factors[1] = u_0_1;
                after->factors[2] = u_0_2;
                after->factors[3] = u_0_3;
                after->factors[4] = u_0_4;
                after->factors[5] = u_0_5;
                after->factors[6] = u_0_6;
                after->factors[7] = u_0_7;
                after->factors[8] = u_0_8;
                after->factors[9] = u_0_9;
                after->factors[10] = u_0_10;
                after->factors[11] = u_0_11;
                after->factors[12] = d_1_2;
                after->factors[13] = u_1_2_2;
                after->factors[14] = u_1_3_2;
                after->factors[15] = u_1_4_2;
                after->factors[16] = u_1_5_2;
                after->factors[17] = u_1_6_2;
                after->factors[18] = u_1_7_2;
                after->factors[19] = u_1_8_2;
                after->factors[20] = u_1_9_2;
                after->factors[21] = u_1_10_2;
                after->factors[22] = u_1_11_2;
                after->factors[23] = d_2_2;
                after->factors[24] = u_2_3;
                after->factors[25] = u_2_4;
                after->factors[26] = u_2_5;
                after->factors[27] = u_2_6;
                after->factors[28] = u_2_7;
                after->factors[29] = u_2_8;
                after->factors[30] = u_2_9;
                after->factors[31] = u_2_10;
                after->factors[32] = u_2_11;
                after->factors[33] = d_3_2;
                after->factors[34] = u_3_4_2;
                after->factors[35] = u_3_5_2;
                after->factors[36] = u_3_6_2;
                after->factors[37] = u_3_7_2;
                after->factors[38] = u_3_8_2;
                after->factors[39] = u_3_9_2;
                after->factors[40] = u_3_10_2;
                after->factors[41] = u_3_11_2;
                after->factors[42] = d_4_2;
                after->factors[43] = u_4_5;
                after->factors[44] = u_4_6;
                after->factors[45] = u_4_7;
                after->factors[46] = u_4_8;
                after->factors[47] = u_4_9;
                after->factors[48] = u_4_10;
                after->factors[49] = u_4_11;
                after->factors[50] = d_5_2;
                after->factors[51] = u_5_6_2;
                after->factors[52] = u_5_7_2;
                after->factors[53] = u_5_8_2;
                after->factors[54] = u_5_9_2;
                after->factors[55] = u_5_10_2;
                after->factors[56] = u_5_11_2;
                after->factors[57] = d_6_2;
                after->factors[58] = u_6_7_2;
                after->factors[59] = u_6_8_2;
                after->factors[60] = u_6_9_2;
                after->factors[61] = u_6_10_2;
                after->factors[62] = u_6_11_2;
                after->factors[63] = d_7_2;
                after->factors[64] = u_7_8_2;
                after->factors[65] = u_7_9_2;
                after->factors[66] = u_7_10_2;
                after->factors[67] = u_7_11_2;
                after->factors[68] = d_8_2;
                after->factors[69] = u_8_9_2;
                after->factors[70] = u_8_10_2;
                after->factors[71] = u_8_11_2;
                after->factors[72] = d_9_2;
                after->factors[73] = u_9_10_2;
                after->factors[74] = u_9_11_2;
                after->factors[75] = d_10_2;
                after->factors[76] = u_10_11_2;
                after->factors[77] = d_11_2;
            }

            /* judge, then commit */
            status = quadrotor_ud_hold_factors(after->factors);
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
    }
    return status;
}

/* 714 additions, 884 multiplications, 42 divisions, 36 negations, 42 selections. */
static quadrotor_ud_status_t quadrotor_ud_update_pose_core(const quadrotor_ud_state_t *before,
                                                           quadrotor_ud_state_t *after,
                                                           const quadrotor_ud_params_t *params, const float pose[6],
                                                           const float gate, quadrotor_ud_update_pose_out_t *out)
{
    float delta[12];
    float nis[1];
    float row_variance[6];
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
            out->variance[0] = params->variance_pose[0] + ((u_0_11 * (u_0_11 * d_11)) + ((u_0_10 * (u_0_10 * d_10)) +
                v_3));
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
            const float v_6 = (u_2_11 * (u_2_11 * d_11)) + ((u_2_10 * (u_2_10 * d_10)) + ((u_2_9 * (u_2_9 * d_9)) +
                v_5));
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
            out->variance[3] = params->variance_pose[3] + ((u_6_11 * (u_6_11 * d_11)) + ((u_6_10 * (u_6_10 * d_10)) +
                v_9));
            const float u_8_11 = before->factors[71];
            const float u_8_10 = before->factors[70];
            const float u_8_9 = before->factors[69];
            const float v_10 = (u_8_11 * (u_8_11 * d_11)) + ((u_8_10 * (u_8_10 * d_10)) + (d_8 + (u_8_9 * (u_8_9 *
                d_9))));
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
            const float loss_1 = -(u_0_1 * per_a_0);
            after->factors[1] = u_0_1 + (d_0 * loss_1);
            const float u_0_2 = before->factors[2];
            const float d_1 = before->factors[12];
            const float v_2 = u_0_1 * d_1;
            const float v_3 = u_0_1 * v_2;
            const float v_4 = d_0 + v_3;
            const float v_5 = v_3 + v;
            const float per_a_1 = 1.0f / ((v_5 >= 1.0e-20f) ? v_5 : 1.0f);
            const float loss_2 = -(u_0_2 * per_a_1);
            const float v_6 = u_0_2 + (v_4 * loss_2);
            after->factors[2] = v_6;
            const float u_0_3 = before->factors[3];
            const float d_2 = before->factors[23];
            const float v_7 = u_0_2 * d_2;
            const float v_8 = u_0_2 * v_7;
            const float v_9 = v_8 + v_4;
            const float v_10 = v_8 + v_5;
            const float per_a_2 = 1.0f / ((v_10 >= 1.0e-20f) ? v_10 : 1.0f);
            const float loss_3 = -(u_0_3 * per_a_2);
            const float v_11 = u_0_3 + (v_9 * loss_3);
            const float new_d_2 = d_2 * (v_5 * per_a_2);
            const float v_12 = new_d_2 * v_6;
            const float u_2_3 = before->factors[24];
            const float v_13 = u_2_3 + (v_7 * loss_3);
            const float r_1 = params->variance_pose[1];
            const float v_14 = r_1 + new_d_2;
            const float per_a_2_2 = 1.0f / ((v_14 >= 1.0e-20f) ? v_14 : 1.0f);
            const float loss_3_2 = -(v_13 * per_a_2_2);
            after->factors[3] = v_11 + (v_12 * loss_3_2);
            const float u_0_4 = before->factors[4];
            const float d_3 = before->factors[33];
            const float v_15 = u_0_3 * d_3;
            const float v_16 = u_0_3 * v_15;
            const float v_17 = v_16 + v_9;
            const float v_18 = v_16 + v_10;
            const float per_a_3 = 1.0f / ((v_18 >= 1.0e-20f) ? v_18 : 1.0f);
            const float loss_4 = -(u_0_4 * per_a_3);
            const float v_19 = u_0_4 + (v_17 * loss_4);
            const float new_d_3 = d_3 * (v_10 * per_a_3);
            const float v_20 = new_d_3 * v_13;
            const float v_21 = v_12 + (v_11 * v_20);
            const float u_2_4 = before->factors[25];
            const float v_22 = v_7 + (u_2_3 * v_15);
            const float v_23 = u_2_4 + (v_22 * loss_4);
            const float v_24 = v_13 * v_20;
            const float v_25 = v_14 + v_24;
            const float per_a_3_2 = 1.0f / ((v_25 >= 1.0e-20f) ? v_25 : 1.0f);
            const float loss_4_2 = -(v_23 * per_a_3_2);
            const float v_26 = v_19 + (v_21 * loss_4_2);
            after->factors[4] = v_26;
            const float u_0_5 = before->factors[5];
            const float d_4 = before->factors[42];
            const float v_27 = u_0_4 * d_4;
            const float v_28 = u_0_4 * v_27;
            const float v_29 = v_28 + v_17;
            const float v_30 = v_28 + v_18;
            const float per_a_4 = 1.0f / ((v_30 >= 1.0e-20f) ? v_30 : 1.0f);
            const float loss_5 = -(u_0_5 * per_a_4);
            const float v_31 = u_0_5 + (v_29 * loss_5);
            const float new_d_4 = d_4 * (v_18 * per_a_4);
            const float v_32 = new_d_4 * v_23;
            const float v_33 = v_21 + (v_19 * v_32);
            const float u_2_5 = before->factors[26];
            const float v_34 = v_22 + (u_2_4 * v_27);
            const float v_35 = u_2_5 + (v_34 * loss_5);
            const float v_36 = v_23 * v_32;
            const float v_37 = v_25 + v_36;
            const float per_a_4_2 = 1.0f / ((v_37 >= 1.0e-20f) ? v_37 : 1.0f);
            const float loss_5_2 = -(v_35 * per_a_4_2);
            const float v_38 = v_31 + (v_33 * loss_5_2);
            const float new_d_4_2 = new_d_4 * (v_25 * per_a_4_2);
            const float v_39 = new_d_4_2 * v_26;
            const float u_4_5 = before->factors[43];
            const float v_40 = u_4_5 + (v_27 * loss_5);
            const float v_41 = v_40 + (v_32 * loss_5_2);
            const float r_2 = params->variance_pose[2];
            const float v_42 = r_2 + new_d_4_2;
            const float per_a_4_3 = 1.0f / ((v_42 >= 1.0e-20f) ? v_42 : 1.0f);
            const float loss_5_3 = -(v_41 * per_a_4_3);
            after->factors[5] = v_38 + (v_39 * loss_5_3);
            const float u_0_6 = before->factors[6];
            const float d_5 = before->factors[50];
            const float v_43 = u_0_5 * d_5;
            const float v_44 = u_0_5 * v_43;
            const float v_45 = v_44 + v_29;
            const float v_46 = v_44 + v_30;
            const float per_a_5 = 1.0f / ((v_46 >= 1.0e-20f) ? v_46 : 1.0f);
            const float loss_6 = -(u_0_6 * per_a_5);
            const float v_47 = u_0_6 + (v_45 * loss_6);
            const float new_d_5 = d_5 * (v_30 * per_a_5);
            const float v_48 = new_d_5 * v_35;
            const float v_49 = v_33 + (v_31 * v_48);
            const float u_2_6 = before->factors[27];
            const float v_50 = v_34 + (u_2_5 * v_43);
            const float v_51 = u_2_6 + (v_50 * loss_6);
            const float v_52 = v_35 * v_48;
            const float v_53 = v_37 + v_52;
            const float per_a_5_2 = 1.0f / ((v_53 >= 1.0e-20f) ? v_53 : 1.0f);
            const float loss_6_2 = -(v_51 * per_a_5_2);
            const float v_54 = v_47 + (v_49 * loss_6_2);
            const float new_d_5_2 = new_d_5 * (v_37 * per_a_5_2);
            const float v_55 = new_d_5_2 * v_41;
            const float v_56 = v_39 + (v_38 * v_55);
            const float u_4_6 = before->factors[44];
            const float v_57 = v_27 + (u_4_5 * v_43);
            const float v_58 = u_4_6 + (v_57 * loss_6);
            const float v_59 = v_32 + (v_40 * v_48);
            const float v_60 = v_58 + (v_59 * loss_6_2);
            const float v_61 = v_41 * v_55;
            const float v_62 = v_42 + v_61;
            const float per_a_5_3 = 1.0f / ((v_62 >= 1.0e-20f) ? v_62 : 1.0f);
            const float loss_6_3 = -(v_60 * per_a_5_3);
            const float v_63 = v_54 + (v_56 * loss_6_3);
            after->factors[6] = v_63;
            const float u_0_7 = before->factors[7];
            const float d_6 = before->factors[57];
            const float v_64 = u_0_6 * d_6;
            const float v_65 = u_0_6 * v_64;
            const float v_66 = v_65 + v_45;
            const float v_67 = v_65 + v_46;
            const float per_a_6 = 1.0f / ((v_67 >= 1.0e-20f) ? v_67 : 1.0f);
            const float loss_7 = -(u_0_7 * per_a_6);
            const float v_68 = u_0_7 + (v_66 * loss_7);
            const float new_d_6 = d_6 * (v_46 * per_a_6);
            const float v_69 = new_d_6 * v_51;
            const float v_70 = v_49 + (v_47 * v_69);
            const float u_2_7 = before->factors[28];
            const float v_71 = v_50 + (u_2_6 * v_64);
            const float v_72 = u_2_7 + (v_71 * loss_7);
            const float v_73 = v_51 * v_69;
            const float v_74 = v_53 + v_73;
            const float per_a_6_2 = 1.0f / ((v_74 >= 1.0e-20f) ? v_74 : 1.0f);
            const float loss_7_2 = -(v_72 * per_a_6_2);
            const float v_75 = v_68 + (v_70 * loss_7_2);
            const float new_d_6_2 = new_d_6 * (v_53 * per_a_6_2);
            const float v_76 = new_d_6_2 * v_60;
            const float v_77 = v_56 + (v_54 * v_76);
            const float u_4_7 = before->factors[45];
            const float v_78 = v_57 + (u_4_6 * v_64);
            const float v_79 = u_4_7 + (v_78 * loss_7);
            const float v_80 = v_59 + (v_58 * v_69);
            const float v_81 = v_79 + (v_80 * loss_7_2);
            const float v_82 = v_60 * v_76;
            const float v_83 = v_62 + v_82;
            const float per_a_6_3 = 1.0f / ((v_83 >= 1.0e-20f) ? v_83 : 1.0f);
            const float loss_7_3 = -(v_81 * per_a_6_3);
            const float v_84 = v_75 + (v_77 * loss_7_3);
            const float new_d_6_3 = new_d_6_2 * (v_62 * per_a_6_3);
            const float v_85 = new_d_6_3 * v_63;
            const float u_6_7 = before->factors[58];
            const float v_86 = u_6_7 + (v_64 * loss_7);
            const float v_87 = v_86 + (v_69 * loss_7_2);
            const float v_88 = v_87 + (v_76 * loss_7_3);
            const float r_3 = params->variance_pose[3];
            const float v_89 = r_3 + new_d_6_3;
            const float per_a_6_4 = 1.0f / ((v_89 >= 1.0e-20f) ? v_89 : 1.0f);
            const float loss_7_4 = -(v_88 * per_a_6_4);
            after->factors[7] = v_84 + (v_85 * loss_7_4);
            const float u_0_8 = before->factors[8];
            const float d_7 = before->factors[63];
            const float v_90 = u_0_7 * d_7;
            const float v_91 = u_0_7 * v_90;
            const float v_92 = v_91 + v_66;
            const float v_93 = v_91 + v_67;
            const float per_a_7 = 1.0f / ((v_93 >= 1.0e-20f) ? v_93 : 1.0f);
            const float loss_8 = -(u_0_8 * per_a_7);
            const float v_94 = u_0_8 + (v_92 * loss_8);
            const float new_d_7 = d_7 * (v_67 * per_a_7);
            const float v_95 = new_d_7 * v_72;
            const float v_96 = v_70 + (v_68 * v_95);
            const float u_2_8 = before->factors[29];
            const float v_97 = v_71 + (u_2_7 * v_90);
            const float v_98 = u_2_8 + (v_97 * loss_8);
            const float v_99 = v_72 * v_95;
            const float v_100 = v_74 + v_99;
            const float per_a_7_2 = 1.0f / ((v_100 >= 1.0e-20f) ? v_100 : 1.0f);
            const float loss_8_2 = -(v_98 * per_a_7_2);
            const float v_101 = v_94 + (v_96 * loss_8_2);
            const float new_d_7_2 = new_d_7 * (v_74 * per_a_7_2);
            const float v_102 = new_d_7_2 * v_81;
            const float v_103 = v_77 + (v_75 * v_102);
            const float u_4_8 = before->factors[46];
            const float v_104 = v_78 + (u_4_7 * v_90);
            const float v_105 = u_4_8 + (v_104 * loss_8);
            const float v_106 = v_80 + (v_79 * v_95);
            const float v_107 = v_105 + (v_106 * loss_8_2);
            const float v_108 = v_81 * v_102;
            const float v_109 = v_83 + v_108;
            const float per_a_7_3 = 1.0f / ((v_109 >= 1.0e-20f) ? v_109 : 1.0f);
            const float loss_8_3 = -(v_107 * per_a_7_3);
            const float v_110 = v_101 + (v_103 * loss_8_3);
            const float new_d_7_3 = new_d_7_2 * (v_83 * per_a_7_3);
            const float v_111 = new_d_7_3 * v_88;
            const float v_112 = v_85 + (v_84 * v_111);
            const float u_6_8 = before->factors[59];
            const float v_113 = v_64 + (u_6_7 * v_90);
            const float v_114 = u_6_8 + (v_113 * loss_8);
            const float v_115 = v_69 + (v_86 * v_95);
            const float v_116 = v_114 + (v_115 * loss_8_2);
            const float v_117 = v_76 + (v_87 * v_102);
            const float v_118 = v_116 + (v_117 * loss_8_3);
            const float v_119 = v_88 * v_111;
            const float v_120 = v_89 + v_119;
            const float per_a_7_4 = 1.0f / ((v_120 >= 1.0e-20f) ? v_120 : 1.0f);
            const float loss_8_4 = -(v_118 * per_a_7_4);
            after->factors[8] = v_110 + (v_112 * loss_8_4);
            const float u_0_9 = before->factors[9];
            const float d_8 = before->factors[68];
            const float v_121 = u_0_8 * d_8;
            const float v_122 = u_0_8 * v_121;
            const float v_123 = v_122 + v_92;
            const float v_124 = v_122 + v_93;
            const float per_a_8 = 1.0f / ((v_124 >= 1.0e-20f) ? v_124 : 1.0f);
            const float loss_9 = -(u_0_9 * per_a_8);
            const float v_125 = u_0_9 + (v_123 * loss_9);
            const float new_d_8 = d_8 * (v_93 * per_a_8);
            const float v_126 = new_d_8 * v_98;
            const float v_127 = v_96 + (v_94 * v_126);
            const float u_2_9 = before->factors[30];
            const float v_128 = v_97 + (u_2_8 * v_121);
            const float v_129 = u_2_9 + (v_128 * loss_9);
            const float v_130 = v_98 * v_126;
            const float v_131 = v_100 + v_130;
            const float per_a_8_2 = 1.0f / ((v_131 >= 1.0e-20f) ? v_131 : 1.0f);
            const float loss_9_2 = -(v_129 * per_a_8_2);
            const float v_132 = v_125 + (v_127 * loss_9_2);
            const float new_d_8_2 = new_d_8 * (v_100 * per_a_8_2);
            const float v_133 = new_d_8_2 * v_107;
            const float v_134 = v_103 + (v_101 * v_133);
            const float u_4_9 = before->factors[47];
            const float v_135 = v_104 + (u_4_8 * v_121);
            const float v_136 = u_4_9 + (v_135 * loss_9);
            const float v_137 = v_106 + (v_105 * v_126);
            const float v_138 = v_136 + (v_137 * loss_9_2);
            const float v_139 = v_107 * v_133;
            const float v_140 = v_109 + v_139;
            const float per_a_8_3 = 1.0f / ((v_140 >= 1.0e-20f) ? v_140 : 1.0f);
            const float loss_9_3 = -(v_138 * per_a_8_3);
            const float v_141 = v_132 + (v_134 * loss_9_3);
            const float new_d_8_3 = new_d_8_2 * (v_109 * per_a_8_3);
            const float v_142 = new_d_8_3 * v_118;
            const float v_143 = v_112 + (v_110 * v_142);
            const float u_6_9 = before->factors[60];
            const float v_144 = v_113 + (u_6_8 * v_121);
            const float v_145 = u_6_9 + (v_144 * loss_9);
            const float v_146 = v_115 + (v_114 * v_126);
            const float v_147 = v_145 + (v_146 * loss_9_2);
            const float v_148 = v_117 + (v_116 * v_133);
            const float v_149 = v_147 + (v_148 * loss_9_3);
            const float v_150 = v_118 * v_142;
            const float v_151 = v_120 + v_150;
            const float per_a_8_4 = 1.0f / ((v_151 >= 1.0e-20f) ? v_151 : 1.0f);
            const float loss_9_4 = -(v_149 * per_a_8_4);
            after->factors[9] = v_141 + (v_143 * loss_9_4);
            const float u_0_10 = before->factors[10];
            const float d_9 = before->factors[72];
            const float v_152 = u_0_9 * d_9;
            const float v_153 = u_0_9 * v_152;
            const float v_154 = v_153 + v_123;
            const float v_155 = v_153 + v_124;
            const float per_a_9 = 1.0f / ((v_155 >= 1.0e-20f) ? v_155 : 1.0f);
            const float loss_10 = -(u_0_10 * per_a_9);
            const float v_156 = u_0_10 + (v_154 * loss_10);
            const float new_d_9 = d_9 * (v_124 * per_a_9);
            const float v_157 = new_d_9 * v_129;
            const float v_158 = v_127 + (v_125 * v_157);
            const float u_2_10 = before->factors[31];
            const float v_159 = v_128 + (u_2_9 * v_152);
            const float v_160 = u_2_10 + (v_159 * loss_10);
            const float v_161 = v_129 * v_157;
            const float v_162 = v_131 + v_161;
            const float per_a_9_2 = 1.0f / ((v_162 >= 1.0e-20f) ? v_162 : 1.0f);
            const float loss_10_2 = -(v_160 * per_a_9_2);
            const float v_163 = v_156 + (v_158 * loss_10_2);
            const float new_d_9_2 = new_d_9 * (v_131 * per_a_9_2);
            const float v_164 = new_d_9_2 * v_138;
            const float v_165 = v_134 + (v_132 * v_164);
            const float u_4_10 = before->factors[48];
            const float v_166 = v_135 + (u_4_9 * v_152);
            const float v_167 = u_4_10 + (v_166 * loss_10);
            const float v_168 = v_137 + (v_136 * v_157);
            const float v_169 = v_167 + (v_168 * loss_10_2);
            const float v_170 = v_138 * v_164;
            const float v_171 = v_140 + v_170;
            const float per_a_9_3 = 1.0f / ((v_171 >= 1.0e-20f) ? v_171 : 1.0f);
            const float loss_10_3 = -(v_169 * per_a_9_3);
            const float v_172 = v_163 + (v_165 * loss_10_3);
            const float new_d_9_3 = new_d_9_2 * (v_140 * per_a_9_3);
            const float v_173 = new_d_9_3 * v_149;
            const float v_174 = v_143 + (v_141 * v_173);
            const float u_6_10 = before->factors[61];
            const float v_175 = v_144 + (u_6_9 * v_152);
            const float v_176 = u_6_10 + (v_175 * loss_10);
            const float v_177 = v_146 + (v_145 * v_157);
            const float v_178 = v_176 + (v_177 * loss_10_2);
            const float v_179 = v_148 + (v_147 * v_164);
            const float v_180 = v_178 + (v_179 * loss_10_3);
            const float v_181 = v_149 * v_173;
            const float v_182 = v_151 + v_181;
            const float per_a_9_4 = 1.0f / ((v_182 >= 1.0e-20f) ? v_182 : 1.0f);
            const float loss_10_4 = -(v_180 * per_a_9_4);
            after->factors[10] = v_172 + (v_174 * loss_10_4);
            const float u_0_11 = before->factors[11];
            const float d_10 = before->factors[75];
            const float v_183 = u_0_10 * d_10;
            const float v_184 = u_0_10 * v_183;
            const float v_185 = v_184 + v_154;
            const float v_186 = v_184 + v_155;
            const float per_a_10 = 1.0f / ((v_186 >= 1.0e-20f) ? v_186 : 1.0f);
            const float loss_11 = -(u_0_11 * per_a_10);
            const float v_187 = u_0_11 + (v_185 * loss_11);
            const float new_d_10 = d_10 * (v_155 * per_a_10);
            const float v_188 = new_d_10 * v_160;
            const float v_189 = v_158 + (v_156 * v_188);
            const float u_2_11 = before->factors[32];
            const float v_190 = v_159 + (u_2_10 * v_183);
            const float v_191 = u_2_11 + (v_190 * loss_11);
            const float v_192 = v_160 * v_188;
            const float v_193 = v_162 + v_192;
            const float per_a_10_2 = 1.0f / ((v_193 >= 1.0e-20f) ? v_193 : 1.0f);
            const float loss_11_2 = -(v_191 * per_a_10_2);
            const float v_194 = v_187 + (v_189 * loss_11_2);
            const float new_d_10_2 = new_d_10 * (v_162 * per_a_10_2);
            const float v_195 = new_d_10_2 * v_169;
            const float v_196 = v_165 + (v_163 * v_195);
            const float u_4_11 = before->factors[49];
            const float v_197 = v_166 + (u_4_10 * v_183);
            const float v_198 = u_4_11 + (v_197 * loss_11);
            const float v_199 = v_168 + (v_167 * v_188);
            const float v_200 = v_198 + (v_199 * loss_11_2);
            const float v_201 = v_169 * v_195;
            const float v_202 = v_171 + v_201;
            const float per_a_10_3 = 1.0f / ((v_202 >= 1.0e-20f) ? v_202 : 1.0f);
            const float loss_11_3 = -(v_200 * per_a_10_3);
            const float v_203 = v_194 + (v_196 * loss_11_3);
            const float new_d_10_3 = new_d_10_2 * (v_171 * per_a_10_3);
            const float v_204 = new_d_10_3 * v_180;
            const float v_205 = v_174 + (v_172 * v_204);
            const float u_6_11 = before->factors[62];
            const float v_206 = v_175 + (u_6_10 * v_183);
            const float v_207 = u_6_11 + (v_206 * loss_11);
            const float v_208 = v_177 + (v_176 * v_188);
            const float v_209 = v_207 + (v_208 * loss_11_2);
            const float v_210 = v_179 + (v_178 * v_195);
            const float v_211 = v_209 + (v_210 * loss_11_3);
            const float v_212 = v_180 * v_204;
            const float v_213 = v_182 + v_212;
            const float per_a_10_4 = 1.0f / ((v_213 >= 1.0e-20f) ? v_213 : 1.0f);
            const float loss_11_4 = -(v_211 * per_a_10_4);
            after->factors[11] = v_203 + (v_205 * loss_11_4);
            after->factors[12] = d_1 * (v * per_a_1);
            const float u_1_2 = before->factors[13];
            const float v_214 = u_1_2 + (v_2 * loss_2);
            after->factors[13] = v_214;
            const float u_1_3 = before->factors[14];
            const float v_215 = v_2 + (u_1_2 * v_7);
            const float v_216 = u_1_3 + (v_215 * loss_3);
            const float v_217 = new_d_2 * v_214;
            after->factors[14] = v_216 + (v_217 * loss_3_2);
            const float u_1_4 = before->factors[15];
            const float v_218 = v_215 + (u_1_3 * v_15);
            const float v_219 = u_1_4 + (v_218 * loss_4);
            const float v_220 = v_217 + (v_216 * v_20);
            const float v_221 = v_219 + (v_220 * loss_4_2);
            after->factors[15] = v_221;
            const float u_1_5 = before->factors[16];
            const float v_222 = v_218 + (u_1_4 * v_27);
            const float v_223 = u_1_5 + (v_222 * loss_5);
            const float v_224 = v_220 + (v_219 * v_32);
            const float v_225 = v_223 + (v_224 * loss_5_2);
            const float v_226 = new_d_4_2 * v_221;
            after->factors[16] = v_225 + (v_226 * loss_5_3);
            const float u_1_6 = before->factors[17];
            const float v_227 = v_222 + (u_1_5 * v_43);
            const float v_228 = u_1_6 + (v_227 * loss_6);
            const float v_229 = v_224 + (v_223 * v_48);
            const float v_230 = v_228 + (v_229 * loss_6_2);
            const float v_231 = v_226 + (v_225 * v_55);
            const float v_232 = v_230 + (v_231 * loss_6_3);
            after->factors[17] = v_232;
            const float u_1_7 = before->factors[18];
            const float v_233 = v_227 + (u_1_6 * v_64);
            const float v_234 = u_1_7 + (v_233 * loss_7);
            const float v_235 = v_229 + (v_228 * v_69);
            const float v_236 = v_234 + (v_235 * loss_7_2);
            const float v_237 = v_231 + (v_230 * v_76);
            const float v_238 = v_236 + (v_237 * loss_7_3);
            const float v_239 = new_d_6_3 * v_232;
            after->factors[18] = v_238 + (v_239 * loss_7_4);
            const float u_1_8 = before->factors[19];
            const float v_240 = v_233 + (u_1_7 * v_90);
            const float v_241 = u_1_8 + (v_240 * loss_8);
            const float v_242 = v_235 + (v_234 * v_95);
            const float v_243 = v_241 + (v_242 * loss_8_2);
            const float v_244 = v_237 + (v_236 * v_102);
            const float v_245 = v_243 + (v_244 * loss_8_3);
            const float v_246 = v_239 + (v_238 * v_111);
            after->factors[19] = v_245 + (v_246 * loss_8_4);
            const float u_1_9 = before->factors[20];
            const float v_247 = v_240 + (u_1_8 * v_121);
            const float v_248 = u_1_9 + (v_247 * loss_9);
            const float v_249 = v_242 + (v_241 * v_126);
            const float v_250 = v_248 + (v_249 * loss_9_2);
            const float v_251 = v_244 + (v_243 * v_133);
            const float v_252 = v_250 + (v_251 * loss_9_3);
            const float v_253 = v_246 + (v_245 * v_142);
            after->factors[20] = v_252 + (v_253 * loss_9_4);
            const float u_1_10 = before->factors[21];
            const float v_254 = v_247 + (u_1_9 * v_152);
            const float v_255 = u_1_10 + (v_254 * loss_10);
            const float v_256 = v_249 + (v_248 * v_157);
            const float v_257 = v_255 + (v_256 * loss_10_2);
            const float v_258 = v_251 + (v_250 * v_164);
            const float v_259 = v_257 + (v_258 * loss_10_3);
            const float v_260 = v_253 + (v_252 * v_173);
            after->factors[21] = v_259 + (v_260 * loss_10_4);
            const float u_1_11 = before->factors[22];
            const float v_261 = v_254 + (u_1_10 * v_183);
            const float v_262 = u_1_11 + (v_261 * loss_11);
            const float v_263 = v_256 + (v_255 * v_188);
            const float v_264 = v_262 + (v_263 * loss_11_2);
            const float v_265 = v_258 + (v_257 * v_195);
            const float v_266 = v_264 + (v_265 * loss_11_3);
            const float v_267 = v_260 + (v_259 * v_204);
            after->factors[22] = v_266 + (v_267 * loss_11_4);
            after->factors[23] = new_d_2 * (r_1 * per_a_2_2);
            after->factors[24] = v_13 + (new_d_2 * loss_3_2);
            const float v_268 = new_d_2 + v_24;
            const float v_269 = v_23 + (v_268 * loss_4_2);
            after->factors[25] = v_269;
            const float v_270 = v_268 + v_36;
            const float v_271 = v_35 + (v_270 * loss_5_2);
            const float v_272 = new_d_4_2 * v_269;
            after->factors[26] = v_271 + (v_272 * loss_5_3);
            const float v_273 = v_270 + v_52;
            const float v_274 = v_51 + (v_273 * loss_6_2);
            const float v_275 = v_272 + (v_271 * v_55);
            const float v_276 = v_274 + (v_275 * loss_6_3);
            after->factors[27] = v_276;
            const float v_277 = v_273 + v_73;
            const float v_278 = v_72 + (v_277 * loss_7_2);
            const float v_279 = v_275 + (v_274 * v_76);
            const float v_280 = v_278 + (v_279 * loss_7_3);
            const float v_281 = new_d_6_3 * v_276;
            after->factors[28] = v_280 + (v_281 * loss_7_4);
            const float v_282 = v_277 + v_99;
            const float v_283 = v_98 + (v_282 * loss_8_2);
            const float v_284 = v_279 + (v_278 * v_102);
            const float v_285 = v_283 + (v_284 * loss_8_3);
            const float v_286 = v_281 + (v_280 * v_111);
            after->factors[29] = v_285 + (v_286 * loss_8_4);
            const float v_287 = v_282 + v_130;
            const float v_288 = v_129 + (v_287 * loss_9_2);
            const float v_289 = v_284 + (v_283 * v_133);
            const float v_290 = v_288 + (v_289 * loss_9_3);
            const float v_291 = v_286 + (v_285 * v_142);
            after->factors[30] = v_290 + (v_291 * loss_9_4);
            const float v_292 = v_287 + v_161;
            const float v_293 = v_160 + (v_292 * loss_10_2);
            const float v_294 = v_289 + (v_288 * v_164);
            const float v_295 = v_293 + (v_294 * loss_10_3);
            const float v_296 = v_291 + (v_290 * v_173);
            after->factors[31] = v_295 + (v_296 * loss_10_4);
            const float v_297 = v_292 + v_192;
            const float v_298 = v_191 + (v_297 * loss_11_2);
            const float v_299 = v_294 + (v_293 * v_195);
            const float v_300 = v_298 + (v_299 * loss_11_3);
            const float v_301 = v_296 + (v_295 * v_204);
            after->factors[32] = v_300 + (v_301 * loss_11_4);
            after->factors[33] = new_d_3 * (v_14 * per_a_3_2);
            const float u_3_4 = before->factors[34];
            const float v_302 = u_3_4 + (v_15 * loss_4);
            const float v_303 = v_302 + (v_20 * loss_4_2);
            after->factors[34] = v_303;
            const float u_3_5 = before->factors[35];
            const float v_304 = v_15 + (u_3_4 * v_27);
            const float v_305 = u_3_5 + (v_304 * loss_5);
            const float v_306 = v_20 + (v_302 * v_32);
            const float v_307 = v_305 + (v_306 * loss_5_2);
            const float v_308 = new_d_4_2 * v_303;
            after->factors[35] = v_307 + (v_308 * loss_5_3);
            const float u_3_6 = before->factors[36];
            const float v_309 = v_304 + (u_3_5 * v_43);
            const float v_310 = u_3_6 + (v_309 * loss_6);
            const float v_311 = v_306 + (v_305 * v_48);
            const float v_312 = v_310 + (v_311 * loss_6_2);
            const float v_313 = v_308 + (v_307 * v_55);
            const float v_314 = v_312 + (v_313 * loss_6_3);
            after->factors[36] = v_314;
            const float u_3_7 = before->factors[37];
            const float v_315 = v_309 + (u_3_6 * v_64);
            const float v_316 = u_3_7 + (v_315 * loss_7);
            const float v_317 = v_311 + (v_310 * v_69);
            const float v_318 = v_316 + (v_317 * loss_7_2);
            const float v_319 = v_313 + (v_312 * v_76);
            const float v_320 = v_318 + (v_319 * loss_7_3);
            const float v_321 = new_d_6_3 * v_314;
            after->factors[37] = v_320 + (v_321 * loss_7_4);
            const float u_3_8 = before->factors[38];
            const float v_322 = v_315 + (u_3_7 * v_90);
            const float v_323 = u_3_8 + (v_322 * loss_8);
            const float v_324 = v_317 + (v_316 * v_95);
            const float v_325 = v_323 + (v_324 * loss_8_2);
            const float v_326 = v_319 + (v_318 * v_102);
            const float v_327 = v_325 + (v_326 * loss_8_3);
            const float v_328 = v_321 + (v_320 * v_111);
            after->factors[38] = v_327 + (v_328 * loss_8_4);
            const float u_3_9 = before->factors[39];
            const float v_329 = v_322 + (u_3_8 * v_121);
            const float v_330 = u_3_9 + (v_329 * loss_9);
            const float v_331 = v_324 + (v_323 * v_126);
            const float v_332 = v_330 + (v_331 * loss_9_2);
            const float v_333 = v_326 + (v_325 * v_133);
            const float v_334 = v_332 + (v_333 * loss_9_3);
            const float v_335 = v_328 + (v_327 * v_142);
            after->factors[39] = v_334 + (v_335 * loss_9_4);
            const float u_3_10 = before->factors[40];
            const float v_336 = v_329 + (u_3_9 * v_152);
            const float v_337 = u_3_10 + (v_336 * loss_10);
            const float v_338 = v_331 + (v_330 * v_157);
            const float v_339 = v_337 + (v_338 * loss_10_2);
            const float v_340 = v_333 + (v_332 * v_164);
            const float v_341 = v_339 + (v_340 * loss_10_3);
            const float v_342 = v_335 + (v_334 * v_173);
            after->factors[40] = v_341 + (v_342 * loss_10_4);
            const float u_3_11 = before->factors[41];
            const float v_343 = v_336 + (u_3_10 * v_183);
            const float v_344 = u_3_11 + (v_343 * loss_11);
            const float v_345 = v_338 + (v_337 * v_188);
            const float v_346 = v_344 + (v_345 * loss_11_2);
            const float v_347 = v_340 + (v_339 * v_195);
            const float v_348 = v_346 + (v_347 * loss_11_3);
            const float v_349 = v_342 + (v_341 * v_204);
            after->factors[41] = v_348 + (v_349 * loss_11_4);
            after->factors[42] = new_d_4_2 * (r_2 * per_a_4_3);
            after->factors[43] = v_41 + (new_d_4_2 * loss_5_3);
            const float v_350 = new_d_4_2 + v_61;
            const float v_351 = v_60 + (v_350 * loss_6_3);
            after->factors[44] = v_351;
            const float v_352 = v_350 + v_82;
            const float v_353 = v_81 + (v_352 * loss_7_3);
            const float v_354 = new_d_6_3 * v_351;
            after->factors[45] = v_353 + (v_354 * loss_7_4);
            const float v_355 = v_352 + v_108;
            const float v_356 = v_107 + (v_355 * loss_8_3);
            const float v_357 = v_354 + (v_353 * v_111);
            after->factors[46] = v_356 + (v_357 * loss_8_4);
            const float v_358 = v_355 + v_139;
            const float v_359 = v_138 + (v_358 * loss_9_3);
            const float v_360 = v_357 + (v_356 * v_142);
            after->factors[47] = v_359 + (v_360 * loss_9_4);
            const float v_361 = v_358 + v_170;
            const float v_362 = v_169 + (v_361 * loss_10_3);
            const float v_363 = v_360 + (v_359 * v_173);
            after->factors[48] = v_362 + (v_363 * loss_10_4);
            const float v_364 = v_361 + v_201;
            const float v_365 = v_200 + (v_364 * loss_11_3);
            const float v_366 = v_363 + (v_362 * v_204);
            after->factors[49] = v_365 + (v_366 * loss_11_4);
            after->factors[50] = new_d_5_2 * (v_42 * per_a_5_3);
            const float u_5_6 = before->factors[51];
            const float v_367 = u_5_6 + (v_43 * loss_6);
            const float v_368 = v_367 + (v_48 * loss_6_2);
            const float v_369 = v_368 + (v_55 * loss_6_3);
            after->factors[51] = v_369;
            const float u_5_7 = before->factors[52];
            const float v_370 = v_43 + (u_5_6 * v_64);
            const float v_371 = u_5_7 + (v_370 * loss_7);
            const float v_372 = v_48 + (v_367 * v_69);
            const float v_373 = v_371 + (v_372 * loss_7_2);
            const float v_374 = v_55 + (v_368 * v_76);
            const float v_375 = v_373 + (v_374 * loss_7_3);
            const float v_376 = new_d_6_3 * v_369;
            after->factors[52] = v_375 + (v_376 * loss_7_4);
            const float u_5_8 = before->factors[53];
            const float v_377 = v_370 + (u_5_7 * v_90);
            const float v_378 = u_5_8 + (v_377 * loss_8);
            const float v_379 = v_372 + (v_371 * v_95);
            const float v_380 = v_378 + (v_379 * loss_8_2);
            const float v_381 = v_374 + (v_373 * v_102);
            const float v_382 = v_380 + (v_381 * loss_8_3);
            const float v_383 = v_376 + (v_375 * v_111);
            after->factors[53] = v_382 + (v_383 * loss_8_4);
            const float u_5_9 = before->factors[54];
            const float v_384 = v_377 + (u_5_8 * v_121);
            const float v_385 = u_5_9 + (v_384 * loss_9);
            const float v_386 = v_379 + (v_378 * v_126);
            const float v_387 = v_385 + (v_386 * loss_9_2);
            const float v_388 = v_381 + (v_380 * v_133);
            const float v_389 = v_387 + (v_388 * loss_9_3);
            const float v_390 = v_383 + (v_382 * v_142);
            after->factors[54] = v_389 + (v_390 * loss_9_4);
            const float u_5_10 = before->factors[55];
            const float v_391 = v_384 + (u_5_9 * v_152);
            const float v_392 = u_5_10 + (v_391 * loss_10);
            const float v_393 = v_386 + (v_385 * v_157);
            const float v_394 = v_392 + (v_393 * loss_10_2);
            const float v_395 = v_388 + (v_387 * v_164);
            const float v_396 = v_394 + (v_395 * loss_10_3);
            const float v_397 = v_390 + (v_389 * v_173);
            after->factors[55] = v_396 + (v_397 * loss_10_4);
            const float u_5_11 = before->factors[56];
            const float v_398 = v_391 + (u_5_10 * v_183);
            const float v_399 = u_5_11 + (v_398 * loss_11);
            const float v_400 = v_393 + (v_392 * v_188);
            const float v_401 = v_399 + (v_400 * loss_11_2);
            const float v_402 = v_395 + (v_394 * v_195);
            const float v_403 = v_401 + (v_402 * loss_11_3);
            const float v_404 = v_397 + (v_396 * v_204);
            after->factors[56] = v_403 + (v_404 * loss_11_4);
            after->factors[57] = new_d_6_3 * (r_3 * per_a_6_4);
            after->factors[58] = v_88 + (new_d_6_3 * loss_7_4);
            const float v_405 = new_d_6_3 + v_119;
            after->factors[59] = v_118 + (v_405 * loss_8_4);
            const float v_406 = v_405 + v_150;
            after->factors[60] = v_149 + (v_406 * loss_9_4);
            const float v_407 = v_406 + v_181;
            after->factors[61] = v_180 + (v_407 * loss_10_4);
            const float v_408 = v_407 + v_212;
            after->factors[62] = v_211 + (v_408 * loss_11_4);
            after->factors[63] = new_d_7_3 * (v_89 * per_a_7_4);
            const float u_7_8 = before->factors[64];
            const float v_409 = u_7_8 + (v_90 * loss_8);
            const float v_410 = v_409 + (v_95 * loss_8_2);
            const float v_411 = v_410 + (v_102 * loss_8_3);
            after->factors[64] = v_411 + (v_111 * loss_8_4);
            const float u_7_9 = before->factors[65];
            const float v_412 = v_90 + (u_7_8 * v_121);
            const float v_413 = u_7_9 + (v_412 * loss_9);
            const float v_414 = v_95 + (v_409 * v_126);
            const float v_415 = v_413 + (v_414 * loss_9_2);
            const float v_416 = v_102 + (v_410 * v_133);
            const float v_417 = v_415 + (v_416 * loss_9_3);
            const float v_418 = v_111 + (v_411 * v_142);
            after->factors[65] = v_417 + (v_418 * loss_9_4);
            const float u_7_10 = before->factors[66];
            const float v_419 = v_412 + (u_7_9 * v_152);
            const float v_420 = u_7_10 + (v_419 * loss_10);
            const float v_421 = v_414 + (v_413 * v_157);
            const float v_422 = v_420 + (v_421 * loss_10_2);
            const float v_423 = v_416 + (v_415 * v_164);
            const float v_424 = v_422 + (v_423 * loss_10_3);
            const float v_425 = v_418 + (v_417 * v_173);
            after->factors[66] = v_424 + (v_425 * loss_10_4);
            const float u_7_11 = before->factors[67];
            const float v_426 = v_419 + (u_7_10 * v_183);
            const float v_427 = u_7_11 + (v_426 * loss_11);
            const float v_428 = v_421 + (v_420 * v_188);
            const float v_429 = v_427 + (v_428 * loss_11_2);
            const float v_430 = v_423 + (v_422 * v_195);
            const float v_431 = v_429 + (v_430 * loss_11_3);
            const float v_432 = v_425 + (v_424 * v_204);
            after->factors[67] = v_431 + (v_432 * loss_11_4);
            after->factors[68] = new_d_8_3 * (v_120 * per_a_8_4);
            const float u_8_9 = before->factors[69];
            const float v_433 = u_8_9 + (v_121 * loss_9);
            const float v_434 = v_433 + (v_126 * loss_9_2);
            const float v_435 = v_434 + (v_133 * loss_9_3);
            after->factors[69] = v_435 + (v_142 * loss_9_4);
            const float u_8_10 = before->factors[70];
            const float v_436 = v_121 + (u_8_9 * v_152);
            const float v_437 = u_8_10 + (v_436 * loss_10);
            const float v_438 = v_126 + (v_433 * v_157);
            const float v_439 = v_437 + (v_438 * loss_10_2);
            const float v_440 = v_133 + (v_434 * v_164);
            const float v_441 = v_439 + (v_440 * loss_10_3);
            const float v_442 = v_142 + (v_435 * v_173);
            after->factors[70] = v_441 + (v_442 * loss_10_4);
            const float u_8_11 = before->factors[71];
            const float v_443 = v_436 + (u_8_10 * v_183);
            const float v_444 = u_8_11 + (v_443 * loss_11);
            const float v_445 = v_438 + (v_437 * v_188);
            const float v_446 = v_444 + (v_445 * loss_11_2);
            const float v_447 = v_440 + (v_439 * v_195);
            const float v_448 = v_446 + (v_447 * loss_11_3);
            const float v_449 = v_442 + (v_441 * v_204);
            after->factors[71] = v_448 + (v_449 * loss_11_4);
            after->factors[72] = new_d_9_3 * (v_151 * per_a_9_4);
            const float u_9_10 = before->factors[73];
            const float v_450 = u_9_10 + (v_152 * loss_10);
            const float v_451 = v_450 + (v_157 * loss_10_2);
            const float v_452 = v_451 + (v_164 * loss_10_3);
            after->factors[73] = v_452 + (v_173 * loss_10_4);
            const float u_9_11 = before->factors[74];
            const float v_453 = v_152 + (u_9_10 * v_183);
            const float v_454 = u_9_11 + (v_453 * loss_11);
            const float v_455 = v_157 + (v_450 * v_188);
            const float v_456 = v_454 + (v_455 * loss_11_2);
            const float v_457 = v_164 + (v_451 * v_195);
            const float v_458 = v_456 + (v_457 * loss_11_3);
            const float v_459 = v_173 + (v_452 * v_204);
            after->factors[74] = v_458 + (v_459 * loss_11_4);
            after->factors[75] = new_d_10_3 * (v_182 * per_a_10_4);
            const float u_10_11 = before->factors[76];
            const float v_460 = u_10_11 + (v_183 * loss_11);
            const float v_461 = v_460 + (v_188 * loss_11_2);
            const float v_462 = v_461 + (v_195 * loss_11_3);
            after->factors[76] = v_462 + (v_204 * loss_11_4);
            const float d_11 = before->factors[77];
            const float v_463 = u_0_11 * d_11;
            const float v_464 = u_0_11 * v_463;
            const float s = v_464 + v_186;
            const float per_a_11 = 1.0f / ((s >= 1.0e-20f) ? s : 1.0f);
            const float new_d_11 = d_11 * (v_186 * per_a_11);
            const float v_465 = new_d_11 * v_191;
            const float v_466 = v_191 * v_465;
            const float s_2 = v_193 + v_466;
            const float per_a_11_2 = 1.0f / ((s_2 >= 1.0e-20f) ? s_2 : 1.0f);
            const float new_d_11_2 = new_d_11 * (v_193 * per_a_11_2);
            const float v_467 = new_d_11_2 * v_200;
            const float v_468 = v_200 * v_467;
            const float s_3 = v_202 + v_468;
            const float per_a_11_3 = 1.0f / ((s_3 >= 1.0e-20f) ? s_3 : 1.0f);
            const float new_d_11_3 = new_d_11_2 * (v_202 * per_a_11_3);
            const float v_469 = new_d_11_3 * v_211;
            const float v_470 = v_211 * v_469;
            const float s_4 = v_213 + v_470;
            const float per_a_11_4 = 1.0f / ((s_4 >= 1.0e-20f) ? s_4 : 1.0f);
            after->factors[77] = new_d_11_3 * (v_213 * per_a_11_4);
            const float weighted_e = residual_0 * per_a_11;
            const float v_471 = (v_190 + (u_2_11 * v_463)) * weighted_e;
            const float e = residual_1 - v_471;
            const float weighted_e_2 = per_a_11_2 * e;
            const float v_472 = ((v_197 + (u_4_11 * v_463)) * weighted_e) + ((v_199 + (v_198 * v_465)) * weighted_e_2);
            const float e_2 = residual_2 - v_472;
            const float weighted_e_3 = per_a_11_3 * e_2;
            const float v_473 = (((v_464 + v_185) * weighted_e) + ((v_189 + (v_187 * v_465)) * weighted_e_2)) + ((v_196
                + (v_194 * v_467)) * weighted_e_3);
            const float v_474 = ((v_206 + (u_6_11 * v_463)) * weighted_e) + ((v_208 + (v_207 * v_465)) * weighted_e_2);
            const float v_475 = v_474 + ((v_210 + (v_209 * v_467)) * weighted_e_3);
            const float e_3 = residual_3 - v_475;
            const float weighted_e_4 = per_a_11_4 * e_3;
            delta[0] = v_473 + ((v_205 + (v_203 * v_469)) * weighted_e_4);
            const float v_476 = ((v_261 + (u_1_11 * v_463)) * weighted_e) + ((v_263 + (v_262 * v_465)) * weighted_e_2);
            delta[1] = (v_476 + ((v_265 + (v_264 * v_467)) * weighted_e_3)) + ((v_267 + (v_266 * v_469)) *
                weighted_e_4);
            const float v_477 = (v_471 + ((v_297 + v_466) * weighted_e_2)) + ((v_299 + (v_298 * v_467)) * weighted_e_3);
            delta[2] = v_477 + ((v_301 + (v_300 * v_469)) * weighted_e_4);
            const float v_478 = ((v_343 + (u_3_11 * v_463)) * weighted_e) + ((v_345 + (v_344 * v_465)) * weighted_e_2);
            delta[3] = (v_478 + ((v_347 + (v_346 * v_467)) * weighted_e_3)) + ((v_349 + (v_348 * v_469)) *
                weighted_e_4);
            delta[4] = (v_472 + ((v_364 + v_468) * weighted_e_3)) + ((v_366 + (v_365 * v_469)) * weighted_e_4);
            const float v_479 = ((v_398 + (u_5_11 * v_463)) * weighted_e) + ((v_400 + (v_399 * v_465)) * weighted_e_2);
            delta[5] = (v_479 + ((v_402 + (v_401 * v_467)) * weighted_e_3)) + ((v_404 + (v_403 * v_469)) *
                weighted_e_4);
            delta[6] = v_475 + ((v_408 + v_470) * weighted_e_4);
            const float v_480 = ((v_426 + (u_7_11 * v_463)) * weighted_e) + ((v_428 + (v_427 * v_465)) * weighted_e_2);
            delta[7] = (v_480 + ((v_430 + (v_429 * v_467)) * weighted_e_3)) + ((v_432 + (v_431 * v_469)) *
                weighted_e_4);
            const float v_481 = ((v_443 + (u_8_11 * v_463)) * weighted_e) + ((v_445 + (v_444 * v_465)) * weighted_e_2);
            delta[8] = (v_481 + ((v_447 + (v_446 * v_467)) * weighted_e_3)) + ((v_449 + (v_448 * v_469)) *
                weighted_e_4);
            const float v_482 = ((v_453 + (u_9_11 * v_463)) * weighted_e) + ((v_455 + (v_454 * v_465)) * weighted_e_2);
            delta[9] = (v_482 + ((v_457 + (v_456 * v_467)) * weighted_e_3)) + ((v_459 + (v_458 * v_469)) *
                weighted_e_4);
            const float v_483 = ((v_183 + (u_10_11 * v_463)) * weighted_e) + ((v_188 + (v_460 * v_465)) * weighted_e_2);
            delta[10] = (v_483 + ((v_195 + (v_461 * v_467)) * weighted_e_3)) + ((v_204 + (v_462 * v_469)) *
                weighted_e_4);
            delta[11] = (((v_463 * weighted_e) + (v_465 * weighted_e_2)) + (v_467 * weighted_e_3)) + (v_469 *
                weighted_e_4);
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
            const float loss_9 = -(u_8_9 * per_a_8);
            after->factors[9] = u_0_9 + (v * loss_9);
            const float u_0_10 = after->factors[10];
            const float d_9 = after->factors[72];
            const float v_3 = u_8_9 * d_9;
            const float v_4 = v + (u_0_9 * v_3);
            const float u_8_10 = after->factors[70];
            const float v_5 = u_8_9 * v_3;
            const float v_6 = v_2 + v_5;
            const float per_a_9 = 1.0f / ((v_6 >= 1.0e-20f) ? v_6 : 1.0f);
            const float loss_10 = -(u_8_10 * per_a_9);
            const float v_7 = u_0_10 + (v_4 * loss_10);
            after->factors[10] = v_7;
            const float u_0_11 = after->factors[11];
            const float d_10 = after->factors[75];
            const float v_8 = u_8_10 * d_10;
            const float v_9 = v_4 + (u_0_10 * v_8);
            const float u_8_11 = after->factors[71];
            const float v_10 = u_8_10 * v_8;
            const float v_11 = v_6 + v_10;
            const float per_a_10 = 1.0f / ((v_11 >= 1.0e-20f) ? v_11 : 1.0f);
            const float loss_11 = -(u_8_11 * per_a_10);
            const float v_12 = u_0_11 + (v_9 * loss_11);
            const float new_d_10 = d_10 * (v_6 * per_a_10);
            const float v_13 = new_d_10 * v_7;
            const float u_10_11 = after->factors[76];
            const float v_14 = u_10_11 + (v_8 * loss_11);
            const float r_5 = params->variance_pose[5];
            const float v_15 = r_5 + new_d_10;
            const float per_a_10_2 = 1.0f / ((v_15 >= 1.0e-20f) ? v_15 : 1.0f);
            const float loss_11_2 = -(v_14 * per_a_10_2);
            after->factors[11] = v_12 + (v_13 * loss_11_2);
            const float u_1_9 = after->factors[20];
            const float u_1_8 = after->factors[19];
            const float v_16 = u_1_8 * d_8;
            after->factors[20] = u_1_9 + (v_16 * loss_9);
            const float u_1_10 = after->factors[21];
            const float v_17 = v_16 + (u_1_9 * v_3);
            const float v_18 = u_1_10 + (v_17 * loss_10);
            after->factors[21] = v_18;
            const float u_1_11 = after->factors[22];
            const float v_19 = v_17 + (u_1_10 * v_8);
            const float v_20 = u_1_11 + (v_19 * loss_11);
            const float v_21 = new_d_10 * v_18;
            after->factors[22] = v_20 + (v_21 * loss_11_2);
            const float u_2_9 = after->factors[30];
            const float u_2_8 = after->factors[29];
            const float v_22 = u_2_8 * d_8;
            after->factors[30] = u_2_9 + (v_22 * loss_9);
            const float u_2_10 = after->factors[31];
            const float v_23 = v_22 + (u_2_9 * v_3);
            const float v_24 = u_2_10 + (v_23 * loss_10);
            after->factors[31] = v_24;
            const float u_2_11 = after->factors[32];
            const float v_25 = v_23 + (u_2_10 * v_8);
            const float v_26 = u_2_11 + (v_25 * loss_11);
            const float v_27 = new_d_10 * v_24;
            after->factors[32] = v_26 + (v_27 * loss_11_2);
            const float u_3_9 = after->factors[39];
            const float u_3_8 = after->factors[38];
            const float v_28 = u_3_8 * d_8;
            after->factors[39] = u_3_9 + (v_28 * loss_9);
            const float u_3_10 = after->factors[40];
            const float v_29 = v_28 + (u_3_9 * v_3);
            const float v_30 = u_3_10 + (v_29 * loss_10);
            after->factors[40] = v_30;
            const float u_3_11 = after->factors[41];
            const float v_31 = v_29 + (u_3_10 * v_8);
            const float v_32 = u_3_11 + (v_31 * loss_11);
            const float v_33 = new_d_10 * v_30;
            after->factors[41] = v_32 + (v_33 * loss_11_2);
            const float u_4_9 = after->factors[47];
            const float u_4_8 = after->factors[46];
            const float v_34 = u_4_8 * d_8;
            after->factors[47] = u_4_9 + (v_34 * loss_9);
            const float u_4_10 = after->factors[48];
            const float v_35 = v_34 + (u_4_9 * v_3);
            const float v_36 = u_4_10 + (v_35 * loss_10);
            after->factors[48] = v_36;
            const float u_4_11 = after->factors[49];
            const float v_37 = v_35 + (u_4_10 * v_8);
            const float v_38 = u_4_11 + (v_37 * loss_11);
            const float v_39 = new_d_10 * v_36;
            after->factors[49] = v_38 + (v_39 * loss_11_2);
            const float u_5_9 = after->factors[54];
            const float u_5_8 = after->factors[53];
            const float v_40 = u_5_8 * d_8;
            after->factors[54] = u_5_9 + (v_40 * loss_9);
            const float u_5_10 = after->factors[55];
            const float v_41 = v_40 + (u_5_9 * v_3);
            const float v_42 = u_5_10 + (v_41 * loss_10);
            after->factors[55] = v_42;
            const float u_5_11 = after->factors[56];
            const float v_43 = v_41 + (u_5_10 * v_8);
            const float v_44 = u_5_11 + (v_43 * loss_11);
            const float v_45 = new_d_10 * v_42;
            after->factors[56] = v_44 + (v_45 * loss_11_2);
            const float u_6_9 = after->factors[60];
            const float u_6_8 = after->factors[59];
            const float v_46 = u_6_8 * d_8;
            after->factors[60] = u_6_9 + (v_46 * loss_9);
            const float u_6_10 = after->factors[61];
            const float v_47 = v_46 + (u_6_9 * v_3);
            const float v_48 = u_6_10 + (v_47 * loss_10);
            after->factors[61] = v_48;
            const float u_6_11 = after->factors[62];
            const float v_49 = v_47 + (u_6_10 * v_8);
            const float v_50 = u_6_11 + (v_49 * loss_11);
            const float v_51 = new_d_10 * v_48;
            after->factors[62] = v_50 + (v_51 * loss_11_2);
            const float u_7_9 = after->factors[65];
            const float u_7_8 = after->factors[64];
            const float v_52 = u_7_8 * d_8;
            after->factors[65] = u_7_9 + (v_52 * loss_9);
            const float u_7_10 = after->factors[66];
            const float v_53 = v_52 + (u_7_9 * v_3);
            const float v_54 = u_7_10 + (v_53 * loss_10);
            after->factors[66] = v_54;
            const float u_7_11 = after->factors[67];
            const float v_55 = v_53 + (u_7_10 * v_8);
            const float v_56 = u_7_11 + (v_55 * loss_11);
            const float v_57 = new_d_10 * v_54;
            after->factors[67] = v_56 + (v_57 * loss_11_2);
            after->factors[68] = d_8 * (r_4 * per_a_8);
            after->factors[69] = u_8_9 + (d_8 * loss_9);
            const float v_58 = d_8 + v_5;
            const float v_59 = u_8_10 + (v_58 * loss_10);
            after->factors[70] = v_59;
            const float v_60 = v_58 + v_10;
            const float v_61 = u_8_11 + (v_60 * loss_11);
            const float v_62 = new_d_10 * v_59;
            after->factors[71] = v_61 + (v_62 * loss_11_2);
            after->factors[72] = d_9 * (v_2 * per_a_9);
            const float u_9_10 = after->factors[73];
            const float v_63 = u_9_10 + (v_3 * loss_10);
            after->factors[73] = v_63;
            const float u_9_11 = after->factors[74];
            const float v_64 = v_3 + (u_9_10 * v_8);
            const float v_65 = u_9_11 + (v_64 * loss_11);
            const float v_66 = new_d_10 * v_63;
            after->factors[74] = v_65 + (v_66 * loss_11_2);
            after->factors[75] = new_d_10 * (r_5 * per_a_10_2);
            after->factors[76] = v_14 + (new_d_10 * loss_11_2);
            const float d_11 = after->factors[77];
            const float v_67 = u_8_11 * d_11;
            const float v_68 = u_8_11 * v_67;
            const float s = v_11 + v_68;
            const float per_a_11 = 1.0f / ((s >= 1.0e-20f) ? s : 1.0f);
            const float new_d_11 = d_11 * (v_11 * per_a_11);
            const float v_69 = new_d_11 * v_14;
            const float v_70 = v_14 * v_69;
            const float s_2 = v_15 + v_70;
            const float per_a_11_2 = 1.0f / ((s_2 >= 1.0e-20f) ? s_2 : 1.0f);
            after->factors[77] = new_d_11 * (v_15 * per_a_11_2);
            const float delta_8 = delta[8];
            const float e = residual_4 - delta_8;
            const float weighted_e = per_a_11 * e;
            const float v_71 = delta[10] + ((v_8 + (u_10_11 * v_67)) * weighted_e);
            const float e_2 = residual_5 - v_71;
            const float weighted_e_2 = per_a_11_2 * e_2;
            delta[0] = (delta[0] + ((v_9 + (u_0_11 * v_67)) * weighted_e)) + ((v_13 + (v_12 * v_69)) * weighted_e_2);
            delta[1] = (delta[1] + ((v_19 + (u_1_11 * v_67)) * weighted_e)) + ((v_21 + (v_20 * v_69)) * weighted_e_2);
            delta[2] = (delta[2] + ((v_25 + (u_2_11 * v_67)) * weighted_e)) + ((v_27 + (v_26 * v_69)) * weighted_e_2);
            delta[3] = (delta[3] + ((v_31 + (u_3_11 * v_67)) * weighted_e)) + ((v_33 + (v_32 * v_69)) * weighted_e_2);
            delta[4] = (delta[4] + ((v_37 + (u_4_11 * v_67)) * weighted_e)) + ((v_39 + (v_38 * v_69)) * weighted_e_2);
            delta[5] = (delta[5] + ((v_43 + (u_5_11 * v_67)) * weighted_e)) + ((v_45 + (v_44 * v_69)) * weighted_e_2);
            delta[6] = (delta[6] + ((v_49 + (u_6_11 * v_67)) * weighted_e)) + ((v_51 + (v_50 * v_69)) * weighted_e_2);
            delta[7] = (delta[7] + ((v_55 + (u_7_11 * v_67)) * weighted_e)) + ((v_57 + (v_56 * v_69)) * weighted_e_2);
            delta[8] = (delta_8 + ((v_60 + v_68) * weighted_e)) + ((v_62 + (v_61 * v_69)) * weighted_e_2);
            delta[9] = (delta[9] + ((v_64 + (u_9_11 * v_67)) * weighted_e)) + ((v_66 + (v_65 * v_69)) * weighted_e_2);
            delta[10] = v_71 + ((new_d_10 + v_70) * weighted_e_2);
            delta[11] = (delta[11] + (v_67 * weighted_e)) + (v_69 * weighted_e_2);
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
                        status = quadrotor_ud_hold_factors(after->factors);
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
        status = quadrotor_ud_hold_factors(after->factors);
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
    return "e19130e8";
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
            text = "a variance was held at its ceiling or floor";
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
