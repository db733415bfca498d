/* quadrotor_jssem_controller: see quadrotor_jssem_controller.h. Written by plantc 0.1.0 from model b00f45d0. */
#include "quadrotor_jssem_controller.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "quadrotor_jssem_controller checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_higher(quadrotor_jssem_controller_status_t first, quadrotor_jssem_controller_status_t second)
{
    return (first > second) ? first : second;
}

/* Mathematics of plantc's own: no sin, exp ... of a C library is called. It takes + - * /, square roots, comparisons
    and
 * exact conversions only, and so gives the same bits on every machine where the FPU rounds to nearest, keeps denormals
 * and NaN (no flush to zero, no default NaN), and products are not fused with sums (-ffp-contract=off). */

/* (sin(x) - x) / x^3 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float quadrotor_jssem_controller_math_sin_series(float z)
{
    float sum = 2.7249926e-6f;

    sum = -0.00019840087f + (z * sum);
    sum = 0.008333332f + (z * sum);
    sum = -0.16666667f + (z * sum);
    return sum;
}

/* (cos(x) - 1 + x^2/2) / x^4 with z = x^2, |x| <= pi/4, as a polynomial of z. */
static float quadrotor_jssem_controller_math_cos_series(float z)
{
    float sum = 0.000024547942f;

    sum = -0.0013888302f + (z * sum);
    sum = 0.041666664f + (z * sum);
    return sum;
}

/* (exp(x) - 1 - x) / x^2 with z = x, |x| <= ln(2)/2, as a polynomial of z. */
static float quadrotor_jssem_controller_math_exp_series(float z)
{
    float sum = 0.00019890981f;

    sum = 0.0013933642f + (z * sum);
    sum = 0.0083333105f + (z * sum);
    sum = 0.041666467f + (z * sum);
    sum = 0.16666667f + (z * sum);
    sum = 0.5f + (z * sum);
    return sum;
}

/* exp(x + rest) 2^shift, for -104.0 <= x <= 89.0 and a small rest: exp(r) 2^n with x = n ln(2) + r. The power of
 * two is a square times 1/2, 1 or 2, so that only the last product rounds. */
static float quadrotor_jssem_controller_math_scaled(float x, float rest, int32_t shift)
{
    static const float fine[16] = {
        1.0f,
        2.0f,
        4.0f,
        8.0f,
        16.0f,
        32.0f,
        64.0f,
        128.0f,
        256.0f,
        512.0f,
        1024.0f,
        2048.0f,
        4096.0f,
        8192.0f,
        16384.0f,
        32768.0f
    };
    static const float coarse[5] = {
        1.0f,
        65536.0f,
        4.2949673e9f,
        2.8147498e14f,
        1.8446744e19f
    };
    const float ratio = (x * 1.442695f) + ((x < 0.0f) ? -0.5f : 0.5f);
    const int32_t nearest = (int32_t)ratio;
    const float count = (float)nearest;
    const int32_t exponent = nearest + shift;
    const int32_t half = exponent / 2;
    const int32_t odd = exponent - (2 * half);
    const uint32_t size = (half < 0) ? (uint32_t)(-half) : (uint32_t)half;
    const float power = fine[size & 15U] * coarse[size >> 4U];
    float root = power;
    float r = (x - (count * 0.69311523f)) + (rest - (count * 0.000031946183f));
    float value;

    /* always between: a prover wants to see it */
    if (r > 0.35f)
    {
        r = 0.35f;
    }
    if (r < -0.35f)
    {
        r = -0.35f;
    }
    value = 1.0f + (r + ((r * r) * quadrotor_jssem_controller_math_exp_series(r)));
    if (half < 0)
    {
        root = 1.0f / power;
    }
    if (odd > 0)
    {
        value = value + value;
    }
    if (odd < 0)
    {
        value = 0.5f * value;
    }
    return (value * root) * root;
}

/* |x| = quadrant pi/2 + remainder[0] + remainder[1], for |x| <= 1073741824: |x| 2/pi in fixed point, of which 62 bits
 * are behind the point. The quadrant is modulo 4. */
static uint32_t quadrotor_jssem_controller_math_reduce(float magnitude, float remainder[2])
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
static float quadrotor_jssem_controller_math_turned(uint32_t quadrant, const float remainder[2])
{
    const float r = remainder[0];
    const float z = r * r;
    float value;

    if ((quadrant & 1U) == 0U)
    {
        const float rest = remainder[1] - (remainder[1] * (0.5f * z));

        value = r + (((r * z) * quadrotor_jssem_controller_math_sin_series(z)) + rest);
    }
    else
    {
        value = 1.0f - ((z * (0.5f - (z * quadrotor_jssem_controller_math_cos_series(z)))) + (r * remainder[1]));
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
static float quadrotor_jssem_controller_math_sin(float x)
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

            value = magnitude + ((magnitude * z) * quadrotor_jssem_controller_math_sin_series(z));
        }
        else if ((magnitude <= 1.0737418e9f) == true)
        {
            float remainder[2];
            const uint32_t quadrant = quadrotor_jssem_controller_math_reduce(magnitude, remainder);

            value = quadrotor_jssem_controller_math_turned(quadrant, remainder);
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
static float quadrotor_jssem_controller_math_cos(float x)
{
    const float magnitude = fabsf(x);
    float value;

    if (magnitude <= 0.7853982f)
    {
        const float z = magnitude * magnitude;

        value = 1.0f - (z * (0.5f - (z * quadrotor_jssem_controller_math_cos_series(z))));
    }
    else if ((magnitude <= 1.0737418e9f) == true)
    {
        float remainder[2];
        const uint32_t quadrant = quadrotor_jssem_controller_math_reduce(magnitude, remainder);

        value = quadrotor_jssem_controller_math_turned(quadrant + 1U, remainder);
    }
    else
    {
        value = NAN;
    }
    return value;
}

/* exp(x): infinity where it overflows, 0 where it underflows; NaN gives NaN.
 * At most 1.1 ulp from the true value. */
static float quadrotor_jssem_controller_math_exp(float x)
{
    float value;

    if ((x >= -104.0f) && (x <= 89.0f))
    {
        value = quadrotor_jssem_controller_math_scaled(x, 0.0f, 0);
    }
    else if (x > 89.0f)
    {
        value = INFINITY;
    }
    else if (x < -104.0f)
    {
        value = 0.0f;
    }
    else
    {
        value = NAN;
    }
    return value;
}

static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_estimator_init_core(
    quadrotor_jssem_controller_estimator_state_t *after, const quadrotor_jssem_controller_estimator_params_t *params)
{
    quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;

    if (!(((params->std_pose >= 0.0f) == true) && ((params->std_pose <= 1000000.0f) == true)
          && ((params->gamma_pose >= 0.0f) == true) && ((params->gamma_pose <= 1000000.0f) == true)
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
          && ((params->yaw_rate_0 >= -100.0f) == true) && ((params->yaw_rate_0 <= 100.0f) == true)))
    {
        status = QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM;
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
    }
    return status;
}

/* 33 additions, 39 multiplications, 1 negation, cosf 3 times, sinf 3 times. */
static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_estimator_predict_core(
    const quadrotor_jssem_controller_estimator_state_t *before, quadrotor_jssem_controller_estimator_state_t *after,
    const float rotor_1, const float rotor_2, const float rotor_3, const float rotor_4)
{
    quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;

    if (!(((rotor_1 >= -1000.0f) == true) && ((rotor_1 <= 1000.0f) == true) && ((rotor_2 >= -1000.0f) == true)
          && ((rotor_2 <= 1000.0f) == true) && ((rotor_3 >= -1000.0f) == true) && ((rotor_3 <= 1000.0f) == true)
          && ((rotor_4 >= -1000.0f) == true) && ((rotor_4 <= 1000.0f) == true)))
    {
        status = QUADROTOR_JSSEM_CONTROLLER_BAD_INPUT;
    }
    else
    {
        /* x = f(x, u) */
        /* x' = vx */
        /* vx' = (sin(yaw) sin(roll) + cos(yaw) sin(pitch)) cos(roll) (thrust_factor (rotor_1^2 + rotor_2^2 +
         * rotor_3^2 + rotor_4^2) / mass) */
        /* y' = vy */
        /* vy' = (sin(yaw) sin(pitch) - cos(yaw) sin(roll)) cos(roll) (thrust_factor (rotor_1^2 + rotor_2^2 +
         * rotor_3^2 + rotor_4^2) / mass) */
        /* z' = vz */
        /* vz' = cos(pitch) cos(roll) (thrust_factor (rotor_1^2 + rotor_2^2 + rotor_3^2 + rotor_4^2) / mass) -
         * gravity */
        /* roll' = roll_rate */
        /* roll_rate' = pitch_rate yaw_rate ((inertia_y - inertia_z) / inertia_x) - (inertia_rotor / inertia_x)
         * pitch_rate (rotor_1 - rotor_2 + rotor_3 - rotor_4) + (arm_length / inertia_x) (thrust_factor (rotor_3^2 -
         * (rotor_1^2 + rotor_2^2) + rotor_4^2)) */
        /* pitch' = pitch_rate */
        /* pitch_rate' = roll_rate yaw_rate ((inertia_z - inertia_x) / inertia_y) + (inertia_rotor / inertia_y)
         * roll_rate (rotor_1 - rotor_2 + rotor_3 - rotor_4) + (arm_length / inertia_y) (thrust_factor (rotor_2^2 -
         * rotor_1^2 + rotor_3^2 - rotor_4^2)) */
        /* yaw' = yaw_rate */
        /* yaw_rate' = roll_rate pitch_rate ((inertia_x - inertia_y) / inertia_z) + drag_factor (rotor_1^2 -
         * rotor_2^2 + rotor_3^2 - rotor_4^2) / inertia_z */
        const float vx = before->vx;
        after->x = before->x + (vx * 0.025f);
        const float yaw = before->yaw;
        const float v = quadrotor_jssem_controller_math_sin(yaw);
        const float roll = before->roll;
        const float v_2 = quadrotor_jssem_controller_math_sin(roll);
        const float v_3 = quadrotor_jssem_controller_math_cos(yaw);
        const float pitch = before->pitch;
        const float v_4 = quadrotor_jssem_controller_math_sin(pitch);
        const float v_5 = quadrotor_jssem_controller_math_cos(roll);
        const float v_6 = rotor_1 * rotor_1;
        const float v_7 = rotor_2 * rotor_2;
        const float v_8 = v_6 + v_7;
        const float v_9 = rotor_3 * rotor_3;
        const float v_10 = rotor_4 * rotor_4;
        const float v_11 = 0.0000542f * ((v_8 + v_9) + v_10);
        after->vx = vx + (0.025f * ((((v * v_2) + (v_3 * v_4)) * v_5) * v_11));
        const float vy = before->vy;
        after->y = before->y + (vy * 0.025f);
        after->vy = vy + (0.025f * (v_11 * (v_5 * ((v * v_4) - (v_2 * v_3)))));
        const float vz = before->vz;
        after->z = before->z + (vz * 0.025f);
        after->vz = vz + (0.025f * ((v_11 * (v_5 * quadrotor_jssem_controller_math_cos(pitch))) - 9.81f));
        const float roll_rate = before->roll_rate;
        after->roll = roll + (roll_rate * 0.025f);
        const float pitch_rate = before->pitch_rate;
        const float yaw_rate = before->yaw_rate;
        const float v_12 = (rotor_3 + (rotor_1 - rotor_2)) - rotor_4;
        const float v_13 = ((-((pitch_rate * yaw_rate) * 0.75308645f)) - ((pitch_rate * 0.012839506f) * v_12)) +
            (0.001605926f * (v_10 + (v_9 - v_8)));
        after->roll_rate = roll_rate + (0.025f * v_13);
        after->pitch = pitch + (pitch_rate * 0.025f);
        const float v_14 = ((0.75308645f * (roll_rate * yaw_rate)) + (v_12 * (roll_rate * 0.012839506f))) +
            (0.001605926f * ((v_9 + (v_7 - v_6)) - v_10));
        after->pitch_rate = pitch_rate + (0.025f * v_14);
        after->yaw = yaw + (yaw_rate * 0.025f);
        after->yaw_rate = yaw_rate + (0.025f * ((1.1e-6f * ((v_9 + (v_6 - v_7)) - v_10)) * 70.42254f));

        if (!(((after->x >= -10000.0f) == true) && ((after->x <= 10000.0f) == true) && ((after->vx >= -1000.0f) == true)
              && ((after->vx <= 1000.0f) == true) && ((after->y >= -10000.0f) == true)
              && ((after->y <= 10000.0f) == true) && ((after->vy >= -1000.0f) == true)
              && ((after->vy <= 1000.0f) == true) && ((after->z >= -10000.0f) == true)
              && ((after->z <= 10000.0f) == true) && ((after->vz >= -1000.0f) == true)
              && ((after->vz <= 1000.0f) == true) && ((after->roll >= -30.0f) == true)
              && ((after->roll <= 30.0f) == true) && ((after->roll_rate >= -100.0f) == true)
              && ((after->roll_rate <= 100.0f) == true) && ((after->pitch >= -30.0f) == true)
              && ((after->pitch <= 30.0f) == true) && ((after->pitch_rate >= -100.0f) == true)
              && ((after->pitch_rate <= 100.0f) == true) && ((after->yaw >= -30.0f) == true)
              && ((after->yaw <= 30.0f) == true) && ((after->yaw_rate >= -100.0f) == true)
              && ((after->yaw_rate <= 100.0f) == true)))
        {
            status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
        }
    }
    return status;
}

/* 36 additions, 27 multiplications, 2 divisions, 1 negation, 18 selections, expf. */
static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_estimator_update_pose_core(
    const quadrotor_jssem_controller_estimator_state_t *before, quadrotor_jssem_controller_estimator_state_t *after,
    const quadrotor_jssem_controller_estimator_params_t *params, const float pose[12],
    quadrotor_jssem_controller_estimator_update_pose_out_t *out)
{
    quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;

    if (!(((pose[0] >= -1000000.0f) == true) && ((pose[0] <= 1000000.0f) == true) && ((pose[1] >= -1000000.0f) == true)
          && ((pose[1] <= 1000000.0f) == true) && ((pose[2] >= -1000000.0f) == true)
          && ((pose[2] <= 1000000.0f) == true) && ((pose[3] >= -1000000.0f) == true)
          && ((pose[3] <= 1000000.0f) == true) && ((pose[4] >= -1000000.0f) == true)
          && ((pose[4] <= 1000000.0f) == true) && ((pose[5] >= -1000000.0f) == true)
          && ((pose[5] <= 1000000.0f) == true) && ((pose[6] >= -1000000.0f) == true)
          && ((pose[6] <= 1000000.0f) == true) && ((pose[7] >= -1000000.0f) == true)
          && ((pose[7] <= 1000000.0f) == true) && ((pose[8] >= -1000000.0f) == true)
          && ((pose[8] <= 1000000.0f) == true) && ((pose[9] >= -1000000.0f) == true)
          && ((pose[9] <= 1000000.0f) == true) && ((pose[10] >= -1000000.0f) == true)
          && ((pose[10] <= 1000000.0f) == true) && ((pose[11] >= -1000000.0f) == true)
          && ((pose[11] <= 1000000.0f) == true)))
    {
        status = QUADROTOR_JSSEM_CONTROLLER_BAD_INPUT;
    }
    else
    {
        /* innovation[0] = pose[0] - (x) */
        /* innovation[1] = pose[1] - (vx) */
        /* innovation[2] = pose[2] - (y) */
        /* innovation[3] = pose[3] - (vy) */
        /* innovation[4] = pose[4] - (z) */
        /* innovation[5] = pose[5] - (vz) */
        /* innovation[6] = pose[6] - (roll) */
        /* innovation[7] = pose[7] - (roll_rate) */
        /* innovation[8] = pose[8] - (pitch) */
        /* innovation[9] = pose[9] - (pitch_rate) */
        /* innovation[10] = pose[10] - (yaw) */
        /* innovation[11] = pose[11] - (yaw_rate) */
        /* e = L innovation, constant weights: n* = 12, c = 10 */
        /* x = x + s e, s = max(0, 1 - r^2 c / D2) exp(-gamma / r^2), D2 = |Pi^-1 C e|^2 */
        const float x = before->x;
        const float innovation_0 = pose[0] - x;
        out->innovation[0] = innovation_0;
        const float vx = before->vx;
        const float innovation_1 = pose[1] - vx;
        out->innovation[1] = innovation_1;
        const float y = before->y;
        const float innovation_2 = pose[2] - y;
        out->innovation[2] = innovation_2;
        const float vy = before->vy;
        const float innovation_3 = pose[3] - vy;
        out->innovation[3] = innovation_3;
        const float z = before->z;
        const float innovation_4 = pose[4] - z;
        out->innovation[4] = innovation_4;
        const float vz = before->vz;
        const float innovation_5 = pose[5] - vz;
        out->innovation[5] = innovation_5;
        const float roll = before->roll;
        const float innovation_6 = pose[6] - roll;
        out->innovation[6] = innovation_6;
        const float roll_rate = before->roll_rate;
        const float innovation_7 = pose[7] - roll_rate;
        out->innovation[7] = innovation_7;
        const float pitch = before->pitch;
        const float innovation_8 = pose[8] - pitch;
        out->innovation[8] = innovation_8;
        const float pitch_rate = before->pitch_rate;
        const float innovation_9 = pose[9] - pitch_rate;
        out->innovation[9] = innovation_9;
        const float yaw = before->yaw;
        const float innovation_10 = pose[10] - yaw;
        out->innovation[10] = innovation_10;
        const float yaw_rate = before->yaw_rate;
        const float innovation_11 = pose[11] - yaw_rate;
        out->innovation[11] = innovation_11;
        const float v = ((innovation_0 * innovation_0) + (innovation_1 * innovation_1)) + (innovation_2 * innovation_2);
        const float v_2 = ((v + (innovation_3 * innovation_3)) + (innovation_4 * innovation_4)) + (innovation_5 *
            innovation_5);
        const float v_3 = ((v_2 + (innovation_6 * innovation_6)) + (innovation_7 * innovation_7)) + (innovation_8 *
            innovation_8);
        const float distance_squared = ((v_3 + (innovation_9 * innovation_9)) + (innovation_10 * innovation_10)) +
            (innovation_11 * innovation_11);
        out->distance_squared = distance_squared;
        const float std_pose = params->std_pose;
        const float v_4 = std_pose * std_pose;
        const float gamma_pose = params->gamma_pose;
        const bool v_5 = !((v_4 < 1.0e-30f) && (0.0f < gamma_pose));
        const float v_6 = v_4 * 10.0f;
        const float v_7 = (v_6 <= distance_squared) ? distance_squared : ((v_6 == v_6) ? v_6 : distance_squared);
        const float v_8 = gamma_pose / ((1.0e-30f <= v_4) ? v_4 : 1.0e-30f);
        const float v_9 = ((0.0f < v_7) ? ((v_7 - v_6) / v_7) : 1.0f) * quadrotor_jssem_controller_math_exp(-((v_8 <=
            1000.0f) ? v_8 : 1000.0f));
        out->weight = v_5 ? v_9 : 0.0f;
        const float v_10 = innovation_0 * v_9;
        after->x = x + (v_5 ? v_10 : 0.0f);
        const float v_11 = innovation_1 * v_9;
        after->vx = vx + (v_5 ? v_11 : 0.0f);
        const float v_12 = innovation_2 * v_9;
        after->y = y + (v_5 ? v_12 : 0.0f);
        const float v_13 = innovation_3 * v_9;
        after->vy = vy + (v_5 ? v_13 : 0.0f);
        const float v_14 = innovation_4 * v_9;
        after->z = z + (v_5 ? v_14 : 0.0f);
        const float v_15 = innovation_5 * v_9;
        after->vz = vz + (v_5 ? v_15 : 0.0f);
        const float v_16 = innovation_6 * v_9;
        after->roll = roll + (v_5 ? v_16 : 0.0f);
        const float v_17 = innovation_7 * v_9;
        after->roll_rate = roll_rate + (v_5 ? v_17 : 0.0f);
        const float v_18 = innovation_8 * v_9;
        after->pitch = pitch + (v_5 ? v_18 : 0.0f);
        const float v_19 = innovation_9 * v_9;
        after->pitch_rate = pitch_rate + (v_5 ? v_19 : 0.0f);
        const float v_20 = innovation_10 * v_9;
        after->yaw = yaw + (v_5 ? v_20 : 0.0f);
        const float v_21 = innovation_11 * v_9;
        after->yaw_rate = yaw_rate + (v_5 ? v_21 : 0.0f);

        if (!(((out->distance_squared >= 0.0f) == true) && ((out->distance_squared <= 1.0e30f) == true)
              && ((out->weight >= -1.0f) == true) && ((out->weight <= 2.0f) == true)))
        {
            status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
        }
        else
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
                status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
            }
        }
    }
    return status;
}

static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_estimator_step_core(
    const quadrotor_jssem_controller_estimator_state_t *before, quadrotor_jssem_controller_estimator_state_t *after,
    const quadrotor_jssem_controller_estimator_params_t *params, const float rotor_1, const float rotor_2,
    const float rotor_3, const float rotor_4, const bool has_pose, const float pose[12],
    quadrotor_jssem_controller_estimator_step_out_t *out)
{
    quadrotor_jssem_controller_estimator_state_t work[1];
    quadrotor_jssem_controller_estimator_state_t *latest = &work[0];
    quadrotor_jssem_controller_estimator_state_t *spare = after;
    quadrotor_jssem_controller_status_t status = quadrotor_jssem_controller_estimator_predict_core(before, latest,
        rotor_1, rotor_2, rotor_3, rotor_4);

    if (status >= QUADROTOR_JSSEM_CONTROLLER_OK)
    {
        /* pose */
        if (has_pose)
        {
            quadrotor_jssem_controller_status_t own = quadrotor_jssem_controller_estimator_update_pose_core(latest,
                spare, params, pose, &out->pose);

            out->status_pose = own;
            if (own >= QUADROTOR_JSSEM_CONTROLLER_OK)
            {
                latest = spare;
                status = quadrotor_jssem_controller_higher(status, own);
            }
            else
            {
                for (uint32_t i = 0U; i < 12U; i++)
                {
                    out->pose.innovation[i] = 0.0f;
                }
                out->pose.distance_squared = 0.0f;
                out->pose.weight = 0.0f;
                status = quadrotor_jssem_controller_higher(status, QUADROTOR_JSSEM_CONTROLLER_SKIPPED);
            }
        }
        else
        {
            for (uint32_t i = 0U; i < 12U; i++)
            {
                out->pose.innovation[i] = 0.0f;
            }
            out->pose.distance_squared = 0.0f;
            out->pose.weight = 0.0f;
            out->status_pose = QUADROTOR_JSSEM_CONTROLLER_OK;
        }
        if (latest != after)
        {
            *after = *latest;
        }
    }
    return status;
}

static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_feedback_init_core(
    quadrotor_jssem_controller_feedback_state_t *after, const quadrotor_jssem_controller_feedback_params_t *params)
{
    quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;

    after->unused = 0U;
    if (!(((params->x >= -10000.0f) == true) && ((params->x <= 10000.0f) == true) && ((params->vx >= -1000.0f) == true)
          && ((params->vx <= 1000.0f) == true) && ((params->y >= -10000.0f) == true)
          && ((params->y <= 10000.0f) == true) && ((params->vy >= -1000.0f) == true)
          && ((params->vy <= 1000.0f) == true) && ((params->z >= -10000.0f) == true)
          && ((params->z <= 10000.0f) == true) && ((params->vz >= -1000.0f) == true)
          && ((params->vz <= 1000.0f) == true) && ((params->roll >= -30.0f) == true)
          && ((params->roll <= 30.0f) == true) && ((params->roll_rate >= -100.0f) == true)
          && ((params->roll_rate <= 100.0f) == true) && ((params->pitch >= -30.0f) == true)
          && ((params->pitch <= 30.0f) == true) && ((params->pitch_rate >= -100.0f) == true)
          && ((params->pitch_rate <= 100.0f) == true) && ((params->yaw >= -30.0f) == true)
          && ((params->yaw <= 30.0f) == true) && ((params->yaw_rate >= -100.0f) == true)
          && ((params->yaw_rate <= 100.0f) == true) && ((params->rotor_1 >= -1000.0f) == true)
          && ((params->rotor_1 <= 1000.0f) == true) && ((params->rotor_2 >= -1000.0f) == true)
          && ((params->rotor_2 <= 1000.0f) == true) && ((params->rotor_3 >= -1000.0f) == true)
          && ((params->rotor_3 <= 1000.0f) == true) && ((params->rotor_4 >= -1000.0f) == true)
          && ((params->rotor_4 <= 1000.0f) == true) && ((params->gain[0] >= -1000000.0f) == true)
          && ((params->gain[0] <= 1000000.0f) == true) && ((params->gain[1] >= -1000000.0f) == true)
          && ((params->gain[1] <= 1000000.0f) == true) && ((params->gain[2] >= -1000000.0f) == true)
          && ((params->gain[2] <= 1000000.0f) == true) && ((params->gain[3] >= -1000000.0f) == true)
          && ((params->gain[3] <= 1000000.0f) == true) && ((params->gain[4] >= -1000000.0f) == true)
          && ((params->gain[4] <= 1000000.0f) == true) && ((params->gain[5] >= -1000000.0f) == true)
          && ((params->gain[5] <= 1000000.0f) == true) && ((params->gain[6] >= -1000000.0f) == true)
          && ((params->gain[6] <= 1000000.0f) == true) && ((params->gain[7] >= -1000000.0f) == true)
          && ((params->gain[7] <= 1000000.0f) == true) && ((params->gain[8] >= -1000000.0f) == true)
          && ((params->gain[8] <= 1000000.0f) == true) && ((params->gain[9] >= -1000000.0f) == true)
          && ((params->gain[9] <= 1000000.0f) == true) && ((params->gain[10] >= -1000000.0f) == true)
          && ((params->gain[10] <= 1000000.0f) == true) && ((params->gain[11] >= -1000000.0f) == true)
          && ((params->gain[11] <= 1000000.0f) == true) && ((params->gain[12] >= -1000000.0f) == true)
          && ((params->gain[12] <= 1000000.0f) == true) && ((params->gain[13] >= -1000000.0f) == true)
          && ((params->gain[13] <= 1000000.0f) == true) && ((params->gain[14] >= -1000000.0f) == true)
          && ((params->gain[14] <= 1000000.0f) == true) && ((params->gain[15] >= -1000000.0f) == true)
          && ((params->gain[15] <= 1000000.0f) == true) && ((params->gain[16] >= -1000000.0f) == true)
          && ((params->gain[16] <= 1000000.0f) == true) && ((params->gain[17] >= -1000000.0f) == true)
          && ((params->gain[17] <= 1000000.0f) == true) && ((params->gain[18] >= -1000000.0f) == true)
          && ((params->gain[18] <= 1000000.0f) == true) && ((params->gain[19] >= -1000000.0f) == true)
          && ((params->gain[19] <= 1000000.0f) == true) && ((params->gain[20] >= -1000000.0f) == true)
          && ((params->gain[20] <= 1000000.0f) == true) && ((params->gain[21] >= -1000000.0f) == true)
          && ((params->gain[21] <= 1000000.0f) == true) && ((params->gain[22] >= -1000000.0f) == true)
          && ((params->gain[22] <= 1000000.0f) == true) && ((params->gain[23] >= -1000000.0f) == true)
          && ((params->gain[23] <= 1000000.0f) == true) && ((params->gain[24] >= -1000000.0f) == true)
          && ((params->gain[24] <= 1000000.0f) == true) && ((params->gain[25] >= -1000000.0f) == true)
          && ((params->gain[25] <= 1000000.0f) == true) && ((params->gain[26] >= -1000000.0f) == true)
          && ((params->gain[26] <= 1000000.0f) == true) && ((params->gain[27] >= -1000000.0f) == true)
          && ((params->gain[27] <= 1000000.0f) == true) && ((params->gain[28] >= -1000000.0f) == true)
          && ((params->gain[28] <= 1000000.0f) == true) && ((params->gain[29] >= -1000000.0f) == true)
          && ((params->gain[29] <= 1000000.0f) == true) && ((params->gain[30] >= -1000000.0f) == true)
          && ((params->gain[30] <= 1000000.0f) == true) && ((params->gain[31] >= -1000000.0f) == true)
          && ((params->gain[31] <= 1000000.0f) == true) && ((params->gain[32] >= -1000000.0f) == true)
          && ((params->gain[32] <= 1000000.0f) == true) && ((params->gain[33] >= -1000000.0f) == true)
          && ((params->gain[33] <= 1000000.0f) == true) && ((params->gain[34] >= -1000000.0f) == true)
          && ((params->gain[34] <= 1000000.0f) == true) && ((params->gain[35] >= -1000000.0f) == true)
          && ((params->gain[35] <= 1000000.0f) == true) && ((params->gain[36] >= -1000000.0f) == true)
          && ((params->gain[36] <= 1000000.0f) == true) && ((params->gain[37] >= -1000000.0f) == true)
          && ((params->gain[37] <= 1000000.0f) == true) && ((params->gain[38] >= -1000000.0f) == true)
          && ((params->gain[38] <= 1000000.0f) == true) && ((params->gain[39] >= -1000000.0f) == true)
          && ((params->gain[39] <= 1000000.0f) == true) && ((params->gain[40] >= -1000000.0f) == true)
          && ((params->gain[40] <= 1000000.0f) == true) && ((params->gain[41] >= -1000000.0f) == true)
          && ((params->gain[41] <= 1000000.0f) == true) && ((params->gain[42] >= -1000000.0f) == true)
          && ((params->gain[42] <= 1000000.0f) == true) && ((params->gain[43] >= -1000000.0f) == true)
          && ((params->gain[43] <= 1000000.0f) == true) && ((params->gain[44] >= -1000000.0f) == true)
          && ((params->gain[44] <= 1000000.0f) == true) && ((params->gain[45] >= -1000000.0f) == true)
          && ((params->gain[45] <= 1000000.0f) == true) && ((params->gain[46] >= -1000000.0f) == true)
          && ((params->gain[46] <= 1000000.0f) == true) && ((params->gain[47] >= -1000000.0f) == true)
          && ((params->gain[47] <= 1000000.0f) == true)))
    {
        status = QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM;
    }
    return status;
}

/* 60 additions, 48 multiplications. */
static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_feedback_step_core(
    const quadrotor_jssem_controller_feedback_state_t *before, quadrotor_jssem_controller_feedback_state_t *after,
    const quadrotor_jssem_controller_feedback_params_t *params, const float x, const float vx, const float y,
    const float vy, const float z, const float vz, const float roll, const float roll_rate, const float pitch,
    const float pitch_rate, const float yaw, const float yaw_rate, quadrotor_jssem_controller_feedback_step_out_t *out)
{
    quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;

    after->unused = 0U;
    (void)before;
    if (!(((x >= -10000.0f) == true) && ((x <= 10000.0f) == true) && ((vx >= -1000.0f) == true)
          && ((vx <= 1000.0f) == true) && ((y >= -10000.0f) == true) && ((y <= 10000.0f) == true)
          && ((vy >= -1000.0f) == true) && ((vy <= 1000.0f) == true) && ((z >= -10000.0f) == true)
          && ((z <= 10000.0f) == true) && ((vz >= -1000.0f) == true) && ((vz <= 1000.0f) == true)
          && ((roll >= -30.0f) == true) && ((roll <= 30.0f) == true) && ((roll_rate >= -100.0f) == true)
          && ((roll_rate <= 100.0f) == true) && ((pitch >= -30.0f) == true) && ((pitch <= 30.0f) == true)
          && ((pitch_rate >= -100.0f) == true) && ((pitch_rate <= 100.0f) == true) && ((yaw >= -30.0f) == true)
          && ((yaw <= 30.0f) == true) && ((yaw_rate >= -100.0f) == true) && ((yaw_rate <= 100.0f) == true)))
    {
        status = QUADROTOR_JSSEM_CONTROLLER_BAD_INPUT;
    }
    else
    {
        /* rotor_1 = rotor_1 - (gain[0] (x - params.x) + gain[1] (vx - params.vx) + gain[2] (y - params.y) + gain[3]
         * (vy - params.vy) + gain[4] (z - params.z) + gain[5] (vz - params.vz) + gain[6] (roll - params.roll) +
         * gain[7] (roll_rate - params.roll_rate) + gain[8] (pitch - params.pitch) + gain[9] (pitch_rate -
         * params.pitch_rate) + gain[10] (yaw - params.yaw) + gain[11] (yaw_rate - params.yaw_rate)) */
        /* rotor_2 = rotor_2 - (gain[12] (x - params.x) + gain[13] (vx - params.vx) + gain[14] (y - params.y) +
         * gain[15] (vy - params.vy) + gain[16] (z - params.z) + gain[17] (vz - params.vz) + gain[18] (roll -
         * params.roll) + gain[19] (roll_rate - params.roll_rate) + gain[20] (pitch - params.pitch) + gain[21]
         * (pitch_rate - params.pitch_rate) + gain[22] (yaw - params.yaw) + gain[23] (yaw_rate - params.yaw_rate)) */
        /* rotor_3 = rotor_3 - (gain[24] (x - params.x) + gain[25] (vx - params.vx) + gain[26] (y - params.y) +
         * gain[27] (vy - params.vy) + gain[28] (z - params.z) + gain[29] (vz - params.vz) + gain[30] (roll -
         * params.roll) + gain[31] (roll_rate - params.roll_rate) + gain[32] (pitch - params.pitch) + gain[33]
         * (pitch_rate - params.pitch_rate) + gain[34] (yaw - params.yaw) + gain[35] (yaw_rate - params.yaw_rate)) */
        /* rotor_4 = rotor_4 - (gain[36] (x - params.x) + gain[37] (vx - params.vx) + gain[38] (y - params.y) +
         * gain[39] (vy - params.vy) + gain[40] (z - params.z) + gain[41] (vz - params.vz) + gain[42] (roll -
         * params.roll) + gain[43] (roll_rate - params.roll_rate) + gain[44] (pitch - params.pitch) + gain[45]
         * (pitch_rate - params.pitch_rate) + gain[46] (yaw - params.yaw) + gain[47] (yaw_rate - params.yaw_rate)) */
        const float v = x - params->x;
        const float v_2 = vx - params->vx;
        const float v_3 = y - params->y;
        const float v_4 = vy - params->vy;
        const float v_5 = (((params->gain[0] * v) + (params->gain[1] * v_2)) + (params->gain[2] * v_3)) +
            (params->gain[3] * v_4);
        const float v_6 = z - params->z;
        const float v_7 = vz - params->vz;
        const float v_8 = roll - params->roll;
        const float v_9 = ((v_5 + (params->gain[4] * v_6)) + (params->gain[5] * v_7)) + (params->gain[6] * v_8);
        const float v_10 = roll_rate - params->roll_rate;
        const float v_11 = pitch - params->pitch;
        const float v_12 = pitch_rate - params->pitch_rate;
        const float v_13 = ((v_9 + (params->gain[7] * v_10)) + (params->gain[8] * v_11)) + (params->gain[9] * v_12);
        const float v_14 = yaw - params->yaw;
        const float v_15 = yaw_rate - params->yaw_rate;
        out->rotor_1 = params->rotor_1 - ((v_13 + (params->gain[10] * v_14)) + (params->gain[11] * v_15));
        const float v_16 = (((params->gain[12] * v) + (params->gain[13] * v_2)) + (params->gain[14] * v_3)) +
            (params->gain[15] * v_4);
        const float v_17 = ((v_16 + (params->gain[16] * v_6)) + (params->gain[17] * v_7)) + (params->gain[18] * v_8);
        const float v_18 = ((v_17 + (params->gain[19] * v_10)) + (params->gain[20] * v_11)) + (params->gain[21] * v_12);
        out->rotor_2 = params->rotor_2 - ((v_18 + (params->gain[22] * v_14)) + (params->gain[23] * v_15));
        const float v_19 = (((params->gain[24] * v) + (params->gain[25] * v_2)) + (params->gain[26] * v_3)) +
            (params->gain[27] * v_4);
        const float v_20 = ((v_19 + (params->gain[28] * v_6)) + (params->gain[29] * v_7)) + (params->gain[30] * v_8);
        const float v_21 = ((v_20 + (params->gain[31] * v_10)) + (params->gain[32] * v_11)) + (params->gain[33] * v_12);
        out->rotor_3 = params->rotor_3 - ((v_21 + (params->gain[34] * v_14)) + (params->gain[35] * v_15));
        const float v_22 = (((params->gain[36] * v) + (params->gain[37] * v_2)) + (params->gain[38] * v_3)) +
            (params->gain[39] * v_4);
        const float v_23 = ((v_22 + (params->gain[40] * v_6)) + (params->gain[41] * v_7)) + (params->gain[42] * v_8);
        const float v_24 = ((v_23 + (params->gain[43] * v_10)) + (params->gain[44] * v_11)) + (params->gain[45] * v_12);
        out->rotor_4 = params->rotor_4 - ((v_24 + (params->gain[46] * v_14)) + (params->gain[47] * v_15));

        if (!(((out->rotor_1 >= -1000.0f) == true) && ((out->rotor_1 <= 1000.0f) == true)))
        {
            status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
        }
        else
        {
            if (!(((out->rotor_2 >= -1000.0f) == true) && ((out->rotor_2 <= 1000.0f) == true)))
            {
                status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
            }
            else
            {
                if (!(((out->rotor_3 >= -1000.0f) == true) && ((out->rotor_3 <= 1000.0f) == true)))
                {
                    status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
                }
                else
                {
                    if (!(((out->rotor_4 >= -1000.0f) == true) && ((out->rotor_4 <= 1000.0f) == true)))
                    {
                        status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
                    }
                }
            }
        }
    }
    return status;
}

static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_init_core(
    quadrotor_jssem_controller_state_t *after, const quadrotor_jssem_controller_params_t *params)
{
    quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;

    if (!(((params->delay_estimator_rotor_1_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_1_0 <= 1000.0f) == true)
          && ((params->delay_estimator_rotor_2_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_2_0 <= 1000.0f) == true)
          && ((params->delay_estimator_rotor_3_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_3_0 <= 1000.0f) == true)
          && ((params->delay_estimator_rotor_4_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_4_0 <= 1000.0f) == true)))
    {
        status = QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM;
    }
    else
    {
        /* estimator: quadrotor_jssem, init */
        const quadrotor_jssem_controller_status_t status_estimator =
            quadrotor_jssem_controller_estimator_init_core(&after->estimator, &params->estimator);
        status = (status_estimator < QUADROTOR_JSSEM_CONTROLLER_OK) ? status_estimator :
            quadrotor_jssem_controller_higher(status, status_estimator);
        if (status >= QUADROTOR_JSSEM_CONTROLLER_OK)
        {
            /* feedback: feedback, init */
            const quadrotor_jssem_controller_status_t status_feedback =
                quadrotor_jssem_controller_feedback_init_core(&after->feedback, &params->feedback);
            status = (status_feedback < QUADROTOR_JSSEM_CONTROLLER_OK) ? status_feedback :
                quadrotor_jssem_controller_higher(status, status_feedback);
            if (status >= QUADROTOR_JSSEM_CONTROLLER_OK)
            {
                after->delay_estimator_rotor_1 = params->delay_estimator_rotor_1_0;
                after->delay_estimator_rotor_2 = params->delay_estimator_rotor_2_0;
                after->delay_estimator_rotor_3 = params->delay_estimator_rotor_3_0;
                after->delay_estimator_rotor_4 = params->delay_estimator_rotor_4_0;
            }
        }
    }
    return status;
}

static quadrotor_jssem_controller_status_t quadrotor_jssem_controller_step_core(
    const quadrotor_jssem_controller_state_t *before, quadrotor_jssem_controller_state_t *after,
    const quadrotor_jssem_controller_params_t *params, const bool estimator_has_pose, const float estimator_pose[12],
    quadrotor_jssem_controller_step_out_t *out)
{
    quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;

    /* estimator: quadrotor_jssem, step */
    const quadrotor_jssem_controller_status_t status_estimator =
        quadrotor_jssem_controller_estimator_step_core(&before->estimator, &after->estimator, &params->estimator,
        before->delay_estimator_rotor_1, before->delay_estimator_rotor_2, before->delay_estimator_rotor_3,
        before->delay_estimator_rotor_4, estimator_has_pose, estimator_pose, &out->estimator);
    status = (status_estimator < QUADROTOR_JSSEM_CONTROLLER_OK) ? status_estimator :
        quadrotor_jssem_controller_higher(status, status_estimator);
    if (status >= QUADROTOR_JSSEM_CONTROLLER_OK)
    {
        /* feedback: feedback, step */
        const quadrotor_jssem_controller_status_t status_feedback =
            quadrotor_jssem_controller_feedback_step_core(&before->feedback, &after->feedback, &params->feedback,
            after->estimator.x, after->estimator.vx, after->estimator.y, after->estimator.vy, after->estimator.z,
            after->estimator.vz, after->estimator.roll, after->estimator.roll_rate, after->estimator.pitch,
            after->estimator.pitch_rate, after->estimator.yaw, after->estimator.yaw_rate, &out->feedback);
        status = (status_feedback < QUADROTOR_JSSEM_CONTROLLER_OK) ? status_feedback :
            quadrotor_jssem_controller_higher(status, status_feedback);
        if (status >= QUADROTOR_JSSEM_CONTROLLER_OK)
        {
            after->delay_estimator_rotor_1 = out->feedback.rotor_1;
            after->delay_estimator_rotor_2 = out->feedback.rotor_2;
            after->delay_estimator_rotor_3 = out->feedback.rotor_3;
            after->delay_estimator_rotor_4 = out->feedback.rotor_4;

            if (!(((after->delay_estimator_rotor_1 >= -1000.0f) == true)
                  && ((after->delay_estimator_rotor_1 <= 1000.0f) == true)
                  && ((after->delay_estimator_rotor_2 >= -1000.0f) == true)
                  && ((after->delay_estimator_rotor_2 <= 1000.0f) == true)
                  && ((after->delay_estimator_rotor_3 >= -1000.0f) == true)
                  && ((after->delay_estimator_rotor_3 <= 1000.0f) == true)
                  && ((after->delay_estimator_rotor_4 >= -1000.0f) == true)
                  && ((after->delay_estimator_rotor_4 <= 1000.0f) == true)))
            {
                status = QUADROTOR_JSSEM_CONTROLLER_OVERFLOW;
            }
        }
    }
    return status;
}

quadrotor_jssem_controller_status_t quadrotor_jssem_controller_init(quadrotor_jssem_controller_state_t *state,
                                                                    const quadrotor_jssem_controller_params_t *params)
{
    quadrotor_jssem_controller_state_t after;
    const quadrotor_jssem_controller_status_t status = quadrotor_jssem_controller_init_core(&after, params);

    if (status >= QUADROTOR_JSSEM_CONTROLLER_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_jssem_controller_status_t quadrotor_jssem_controller_step(quadrotor_jssem_controller_state_t *state,
                                                                    const quadrotor_jssem_controller_params_t *params,
                                                                    const quadrotor_jssem_controller_step_in_t *in,
                                                                    quadrotor_jssem_controller_step_out_t *out)
{
    quadrotor_jssem_controller_state_t after;
    quadrotor_jssem_controller_step_out_t answer;
    const quadrotor_jssem_controller_status_t status = quadrotor_jssem_controller_step_core(state, &after, params,
        in->estimator_has_pose, in->estimator_pose, &answer);

    if (status >= QUADROTOR_JSSEM_CONTROLLER_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

/* The hash of the model, as in the header. */
const char *quadrotor_jssem_controller_model(void)
{
    return "b00f45d0";
}

/* A sentence for a status. */
const char *quadrotor_jssem_controller_status_text(quadrotor_jssem_controller_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case QUADROTOR_JSSEM_CONTROLLER_OK:
            text = "ok";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_CLAMPED:
            text = "a value (a variance, a command) was held at its limit";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case QUADROTOR_JSSEM_CONTROLLER_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
