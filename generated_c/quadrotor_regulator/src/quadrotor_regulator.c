/* quadrotor_regulator: see quadrotor_regulator.h. Written by plantc 0.1.0 from model 982acaf4. */
#include "quadrotor_regulator.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "quadrotor_regulator checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static quadrotor_regulator_status_t quadrotor_regulator_higher(quadrotor_regulator_status_t first, quadrotor_regulator_status_t second)
{
    return (first > second) ? first : second;
}

/* Whether every element is within its bounds; false for NaN. A comparison that decides what is stored is written
 * (... == true), from which Frama-C sees that NaN does not pass. */
static bool quadrotor_regulator_generator_x_is_held(const float covariance[28])
{
    bool held = true;

    for (uint32_t i = 0U; (i < 28U) && held; i++)
    {
        held = ((covariance[i] >= -1.0e9f) == true)
               && ((covariance[i] <= 1.0e9f) == true);
    }
    return held
           && ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[7] >= 1.0e-20f) == true)
           && ((covariance[13] >= 1.0e-20f) == true)
           && ((covariance[18] >= 1.0e-20f) == true)
           && ((covariance[22] >= 1.0e-20f) == true)
           && ((covariance[25] >= 1.0e-20f) == true)
           && ((covariance[27] >= 1.0e-20f) == true);
}

/* Keeps the variances between floor and ceiling; called only when one is outside. Scaling row and column together keeps
 * the matrix positive definite. What lies beside the diagonal is then compared with its bounds. */
static quadrotor_regulator_status_t quadrotor_regulator_generator_x_hold_variances(float covariance[28])
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 7U; i++)
    {
        if (!((covariance[at] >= 0.0f) == true))
        {
            status = QUADROTOR_REGULATOR_NOT_POSITIVE;
        }
        at = at + (7U - i);
    }
    at = 0U;
    for (uint32_t i = 0U; (i < 7U) && (status >= QUADROTOR_REGULATOR_OK); i++)
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
                other = other + ((7U - 1U) - j);
            }
            for (uint32_t j = i + 1U; j < 7U; j++)
            {
                covariance[at + (j - i)] = covariance[at + (j - i)] * factor;
            }
            covariance[at] = ceiling_i;
            status = QUADROTOR_REGULATOR_CLAMPED;
        }
        else if (covariance[at] < floor_i)
        {
            covariance[at] = floor_i;
            status = QUADROTOR_REGULATOR_CLAMPED;
        }
        else
        {
            /* within its bounds */
        }
        at = at + (7U - i);
    }
    if ((status >= QUADROTOR_REGULATOR_OK) && (!quadrotor_regulator_generator_x_is_held(covariance)))
    {
        status = QUADROTOR_REGULATOR_OVERFLOW;
    }
    return status;
}

/* Whether a covariance is within its bounds beyond doubt. Elements that are small, and whose sum is not far below
 * zero, are not far below zero themselves. False for NaN. */
static bool quadrotor_regulator_generator_x_is_bounded(const float covariance[28])
{
    return ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[7] >= 1.0e-20f) == true)
           && ((covariance[13] >= 1.0e-20f) == true)
           && ((covariance[18] >= 1.0e-20f) == true)
           && ((covariance[22] >= 1.0e-20f) == true)
           && ((covariance[25] >= 1.0e-20f) == true)
           && ((covariance[27] >= 1.0e-20f) == true)
           && ((((((((covariance[0] + covariance[7]) + covariance[13]) + covariance[18]) + covariance[22]) +
               covariance[25]) + covariance[27]) <= 9.9e8f) == true)
           && ((covariance[1] <= 6.2e7f) == true)
           && ((covariance[2] <= 6.2e7f) == true)
           && ((covariance[3] <= 6.2e7f) == true)
           && ((covariance[4] <= 6.2e7f) == true)
           && ((covariance[5] <= 6.2e7f) == true)
           && ((covariance[6] <= 6.2e7f) == true)
           && ((covariance[8] <= 6.2e7f) == true)
           && ((covariance[9] <= 6.2e7f) == true)
           && (((((((((covariance[1] + covariance[2]) + covariance[3]) + covariance[4]) + covariance[5]) +
               covariance[6]) + covariance[8]) + covariance[9]) >= -5.0e8f) == true)
           && ((covariance[10] <= 6.2e7f) == true)
           && ((covariance[11] <= 6.2e7f) == true)
           && ((covariance[12] <= 6.2e7f) == true)
           && ((covariance[14] <= 6.2e7f) == true)
           && ((covariance[15] <= 6.2e7f) == true)
           && ((covariance[16] <= 6.2e7f) == true)
           && ((covariance[17] <= 6.2e7f) == true)
           && ((covariance[19] <= 6.2e7f) == true)
           && (((((((((covariance[10] + covariance[11]) + covariance[12]) + covariance[14]) + covariance[15]) +
               covariance[16]) + covariance[17]) + covariance[19]) >= -5.0e8f) == true)
           && ((covariance[20] <= 1.0e8f) == true)
           && ((covariance[21] <= 1.0e8f) == true)
           && ((covariance[23] <= 1.0e8f) == true)
           && ((covariance[24] <= 1.0e8f) == true)
           && ((covariance[26] <= 1.0e8f) == true)
           && ((((((covariance[20] + covariance[21]) + covariance[23]) + covariance[24]) + covariance[26]) >= -5.0e8f)
               == true);
}

static quadrotor_regulator_status_t quadrotor_regulator_generator_x_init_core(
    quadrotor_regulator_generator_x_state_t *after, const quadrotor_regulator_generator_x_params_t *params)
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    if (!(((params->variance_step_w_reading[0] >= 0.0f) == true)
          && ((params->variance_step_w_reading[0] <= 1000000.0f) == true)
          && ((params->variance_step_w_reading[1] >= 0.0f) == true)
          && ((params->variance_step_w_reading[1] <= 1000000.0f) == true)
          && ((params->variance_step_w_reading[2] >= 0.0f) == true)
          && ((params->variance_step_w_reading[2] <= 1000000.0f) == true)
          && ((params->variance_step_w_reading[3] >= 0.0f) == true)
          && ((params->variance_step_w_reading[3] <= 1000000.0f) == true)
          && ((params->variance_step_w_reading[4] >= 0.0f) == true)
          && ((params->variance_step_w_reading[4] <= 1000000.0f) == true)
          && ((params->variance_step_w_reading[5] >= 0.0f) == true)
          && ((params->variance_step_w_reading[5] <= 1000000.0f) == true)
          && ((params->variance_step_w_reading[6] >= 0.0f) == true)
          && ((params->variance_step_w_reading[6] <= 1000000.0f) == true)
          && ((params->variance_reading >= 1.0e-12f) == true) && ((params->variance_reading <= 1000000.0f) == true)
          && ((params->gate_reading >= 0.0f) == true) && ((params->gate_reading <= 1000000.0f) == true)
          && ((params->inflation >= 1.0f) == true) && ((params->inflation <= 1000000.0f) == true)
          && ((params->w_reading_0[0] >= -1000000.0f) == true) && ((params->w_reading_0[0] <= 1000000.0f) == true)
          && ((params->w_reading_0[1] >= -1000000.0f) == true) && ((params->w_reading_0[1] <= 1000000.0f) == true)
          && ((params->w_reading_0[2] >= -1000000.0f) == true) && ((params->w_reading_0[2] <= 1000000.0f) == true)
          && ((params->w_reading_0[3] >= -1000000.0f) == true) && ((params->w_reading_0[3] <= 1000000.0f) == true)
          && ((params->w_reading_0[4] >= -1000000.0f) == true) && ((params->w_reading_0[4] <= 1000000.0f) == true)
          && ((params->w_reading_0[5] >= -1000000.0f) == true) && ((params->w_reading_0[5] <= 1000000.0f) == true)
          && ((params->w_reading_0[6] >= -1000000.0f) == true) && ((params->w_reading_0[6] <= 1000000.0f) == true)
          && ((params->variance_w_reading_0[0] >= 1.0e-12f) == true)
          && ((params->variance_w_reading_0[0] <= 1000000.0f) == true)
          && ((params->variance_w_reading_0[1] >= 1.0e-12f) == true)
          && ((params->variance_w_reading_0[1] <= 1000000.0f) == true)
          && ((params->variance_w_reading_0[2] >= 1.0e-12f) == true)
          && ((params->variance_w_reading_0[2] <= 1000000.0f) == true)
          && ((params->variance_w_reading_0[3] >= 1.0e-12f) == true)
          && ((params->variance_w_reading_0[3] <= 1000000.0f) == true)
          && ((params->variance_w_reading_0[4] >= 1.0e-12f) == true)
          && ((params->variance_w_reading_0[4] <= 1000000.0f) == true)
          && ((params->variance_w_reading_0[5] >= 1.0e-12f) == true)
          && ((params->variance_w_reading_0[5] <= 1000000.0f) == true)
          && ((params->variance_w_reading_0[6] >= 1.0e-12f) == true)
          && ((params->variance_w_reading_0[6] <= 1000000.0f) == true)))
    {
        status = QUADROTOR_REGULATOR_BAD_PARAM;
    }
    else
    {
        after->w_reading[0] = params->w_reading_0[0];
        after->w_reading[1] = params->w_reading_0[1];
        after->w_reading[2] = params->w_reading_0[2];
        after->w_reading[3] = params->w_reading_0[3];
        after->w_reading[4] = params->w_reading_0[4];
        after->w_reading[5] = params->w_reading_0[5];
        after->w_reading[6] = params->w_reading_0[6];
        for (uint32_t i = 0U; i < 28U; i++)
        {
            after->covariance[i] = 0.0f;
        }
        after->covariance[0] = params->variance_w_reading_0[0];
        after->covariance[7] = params->variance_w_reading_0[1];
        after->covariance[13] = params->variance_w_reading_0[2];
        after->covariance[18] = params->variance_w_reading_0[3];
        after->covariance[22] = params->variance_w_reading_0[4];
        after->covariance[25] = params->variance_w_reading_0[5];
        after->covariance[27] = params->variance_w_reading_0[6];
        after->rejected_reading = 0U;

        /* judge, then commit */
        if (!quadrotor_regulator_generator_x_is_bounded(after->covariance))
        {
            status = quadrotor_regulator_generator_x_hold_variances(after->covariance);
        }
    }
    return status;
}

/* 61 additions, 49 multiplications. */
static quadrotor_regulator_status_t quadrotor_regulator_generator_x_predict_core(
    const quadrotor_regulator_generator_x_state_t *before, quadrotor_regulator_generator_x_state_t *after,
    const quadrotor_regulator_generator_x_params_t *params)
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    after->rejected_reading = before->rejected_reading;

    /* x = f(x, u) */
    /* w_reading[0]+ = w_reading[0] + 0.02 w_reading[1] */
    /* w_reading[1]+ = w_reading[1] + 0.02 w_reading[2] */
    /* w_reading[2]+ = w_reading[2] + 0.02 w_reading[3] */
    /* w_reading[3]+ = w_reading[3] + 0.02 w_reading[4] */
    /* w_reading[4]+ = w_reading[4] + 0.02 w_reading[5] */
    /* w_reading[5]+ = w_reading[5] + 0.02 w_reading[6] */
    /* w_reading[6]+ = w_reading[6] */
    const float w_reading_1 = before->w_reading[1];
    after->w_reading[0] = before->w_reading[0] + (w_reading_1 * 0.02f);
    const float w_reading_2 = before->w_reading[2];
    after->w_reading[1] = w_reading_1 + (w_reading_2 * 0.02f);
    const float w_reading_3 = before->w_reading[3];
    after->w_reading[2] = w_reading_2 + (w_reading_3 * 0.02f);
    const float w_reading_4 = before->w_reading[4];
    after->w_reading[3] = w_reading_3 + (w_reading_4 * 0.02f);
    const float w_reading_5 = before->w_reading[5];
    after->w_reading[4] = w_reading_4 + (w_reading_5 * 0.02f);
    const float w_reading_6 = before->w_reading[6];
    after->w_reading[5] = w_reading_5 + (w_reading_6 * 0.02f);
    after->w_reading[6] = w_reading_6;

    /* P = F P F' + Q */
    {
        const float p_0_1 = before->covariance[1];
        const float p_1_1 = before->covariance[7];
        const float v = p_0_1 + (0.02f * p_1_1);
        after->covariance[0] = params->variance_step_w_reading[0] + ((before->covariance[0] + (0.02f * p_0_1)) + (0.02f
            * v));
        const float p_1_2 = before->covariance[8];
        const float v_2 = 0.02f * p_1_2;
        const float v_3 = before->covariance[2] + v_2;
        after->covariance[1] = v + (0.02f * v_3);
        const float p_1_3 = before->covariance[9];
        const float v_4 = before->covariance[3] + (0.02f * p_1_3);
        after->covariance[2] = v_3 + (0.02f * v_4);
        const float p_1_4 = before->covariance[10];
        const float v_5 = before->covariance[4] + (0.02f * p_1_4);
        after->covariance[3] = v_4 + (0.02f * v_5);
        const float p_1_5 = before->covariance[11];
        const float v_6 = before->covariance[5] + (0.02f * p_1_5);
        after->covariance[4] = v_5 + (0.02f * v_6);
        const float p_1_6 = before->covariance[12];
        const float v_7 = before->covariance[6] + (0.02f * p_1_6);
        after->covariance[5] = v_6 + (0.02f * v_7);
        after->covariance[6] = v_7;
        const float p_2_2 = before->covariance[13];
        const float v_8 = p_1_2 + (0.02f * p_2_2);
        after->covariance[7] = params->variance_step_w_reading[1] + ((p_1_1 + v_2) + (0.02f * v_8));
        const float p_2_3 = before->covariance[14];
        const float v_9 = 0.02f * p_2_3;
        const float v_10 = p_1_3 + v_9;
        after->covariance[8] = v_8 + (0.02f * v_10);
        const float p_2_4 = before->covariance[15];
        const float v_11 = p_1_4 + (0.02f * p_2_4);
        after->covariance[9] = v_10 + (0.02f * v_11);
        const float p_2_5 = before->covariance[16];
        const float v_12 = p_1_5 + (0.02f * p_2_5);
        after->covariance[10] = v_11 + (0.02f * v_12);
        const float p_2_6 = before->covariance[17];
        const float v_13 = p_1_6 + (0.02f * p_2_6);
        after->covariance[11] = v_12 + (0.02f * v_13);
        after->covariance[12] = v_13;
        const float p_3_3 = before->covariance[18];
        const float v_14 = p_2_3 + (0.02f * p_3_3);
        after->covariance[13] = params->variance_step_w_reading[2] + ((p_2_2 + v_9) + (0.02f * v_14));
        const float p_3_4 = before->covariance[19];
        const float v_15 = 0.02f * p_3_4;
        const float v_16 = p_2_4 + v_15;
        after->covariance[14] = v_14 + (0.02f * v_16);
        const float p_3_5 = before->covariance[20];
        const float v_17 = p_2_5 + (0.02f * p_3_5);
        after->covariance[15] = v_16 + (0.02f * v_17);
        const float p_3_6 = before->covariance[21];
        const float v_18 = p_2_6 + (0.02f * p_3_6);
        after->covariance[16] = v_17 + (0.02f * v_18);
        after->covariance[17] = v_18;
        const float p_4_4 = before->covariance[22];
        const float v_19 = p_3_4 + (0.02f * p_4_4);
        after->covariance[18] = params->variance_step_w_reading[3] + ((p_3_3 + v_15) + (0.02f * v_19));
        const float p_4_5 = before->covariance[23];
        const float v_20 = 0.02f * p_4_5;
        const float v_21 = p_3_5 + v_20;
        after->covariance[19] = v_19 + (0.02f * v_21);
        const float p_4_6 = before->covariance[24];
        const float v_22 = p_3_6 + (0.02f * p_4_6);
        after->covariance[20] = v_21 + (0.02f * v_22);
        after->covariance[21] = v_22;
        const float p_5_5 = before->covariance[25];
        const float v_23 = p_4_5 + (0.02f * p_5_5);
        after->covariance[22] = params->variance_step_w_reading[4] + ((p_4_4 + v_20) + (0.02f * v_23));
        const float p_5_6 = before->covariance[26];
        const float v_24 = 0.02f * p_5_6;
        const float v_25 = p_4_6 + v_24;
        after->covariance[23] = v_23 + (0.02f * v_25);
        after->covariance[24] = v_25;
        const float p_6_6 = before->covariance[27];
        const float v_26 = p_5_6 + (0.02f * p_6_6);
        after->covariance[25] = params->variance_step_w_reading[5] + ((p_5_5 + v_24) + (0.02f * v_26));
        after->covariance[26] = v_26;
        after->covariance[27] = params->variance_step_w_reading[6] + p_6_6;
    }

    /* judge, then commit */
    if (!quadrotor_regulator_generator_x_is_bounded(after->covariance))
    {
        status = quadrotor_regulator_generator_x_hold_variances(after->covariance);
    }
    if (status >= QUADROTOR_REGULATOR_OK)
    {
        if (!(((after->w_reading[0] >= -1000000.0f) == true) && ((after->w_reading[0] <= 1000000.0f) == true)
              && ((after->w_reading[1] >= -1000000.0f) == true) && ((after->w_reading[1] <= 1000000.0f) == true)
              && ((after->w_reading[2] >= -1000000.0f) == true) && ((after->w_reading[2] <= 1000000.0f) == true)
              && ((after->w_reading[3] >= -1000000.0f) == true) && ((after->w_reading[3] <= 1000000.0f) == true)
              && ((after->w_reading[4] >= -1000000.0f) == true) && ((after->w_reading[4] <= 1000000.0f) == true)
              && ((after->w_reading[5] >= -1000000.0f) == true) && ((after->w_reading[5] <= 1000000.0f) == true)
              && ((after->w_reading[6] >= -1000000.0f) == true) && ((after->w_reading[6] <= 1000000.0f) == true)))
        {
            status = QUADROTOR_REGULATOR_OVERFLOW;
        }
    }
    return status;
}

/* 31 additions, 44 multiplications, 1 division, 3 negations, 1 selection. */
static quadrotor_regulator_status_t quadrotor_regulator_generator_x_update_reading_core(
    const quadrotor_regulator_generator_x_state_t *before, quadrotor_regulator_generator_x_state_t *after,
    const quadrotor_regulator_generator_x_params_t *params, const float reading, const float gate,
    quadrotor_regulator_generator_x_update_reading_out_t *out)
{
    float delta[7];
    float nis[1];
    float row_variance[1];
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    if (!(((reading >= -10.0f) == true) && ((reading <= 10.0f) == true)))
    {
        status = QUADROTOR_REGULATOR_BAD_INPUT;
    }
    else
    {
        /* residual = reading - (w_reading[0]) */
        const float residual = reading - before->w_reading[0];

        /* variance of the innovation: diagonal of H P H' + R */
        {
            out->variance = params->variance_reading + before->covariance[0];
        }
        out->innovation = residual;

        /* d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const float p_0_0 = before->covariance[0];
            const float r_0 = params->variance_reading;
            const float s = r_0 + p_0_0;
            const float per_s = 1.0f / ((s >= 1.0e-20f) ? s : 1.0f);
            const float minus_per_s = -per_s;
            const float n_0 = p_0_0 * minus_per_s;
            const float minus_r = -r_0;
            after->covariance[0] = n_0 * minus_r;
            const float p_0_1 = before->covariance[1];
            const float n_1 = p_0_1 * minus_per_s;
            after->covariance[1] = n_1 * minus_r;
            const float p_0_2 = before->covariance[2];
            const float n_2 = p_0_2 * minus_per_s;
            after->covariance[2] = n_2 * minus_r;
            const float p_0_3 = before->covariance[3];
            const float n_3 = p_0_3 * minus_per_s;
            after->covariance[3] = n_3 * minus_r;
            const float p_0_4 = before->covariance[4];
            const float n_4 = p_0_4 * minus_per_s;
            after->covariance[4] = n_4 * minus_r;
            const float p_0_5 = before->covariance[5];
            const float n_5 = p_0_5 * minus_per_s;
            after->covariance[5] = n_5 * minus_r;
            const float p_0_6 = before->covariance[6];
            const float n_6 = p_0_6 * minus_per_s;
            after->covariance[6] = n_6 * minus_r;
            after->covariance[7] = before->covariance[7] + (p_0_1 * n_1);
            after->covariance[8] = before->covariance[8] + (p_0_2 * n_1);
            after->covariance[9] = before->covariance[9] + (p_0_3 * n_1);
            after->covariance[10] = before->covariance[10] + (p_0_4 * n_1);
            after->covariance[11] = before->covariance[11] + (p_0_5 * n_1);
            after->covariance[12] = before->covariance[12] + (p_0_6 * n_1);
            after->covariance[13] = before->covariance[13] + (p_0_2 * n_2);
            after->covariance[14] = before->covariance[14] + (p_0_3 * n_2);
            after->covariance[15] = before->covariance[15] + (p_0_4 * n_2);
            after->covariance[16] = before->covariance[16] + (p_0_5 * n_2);
            after->covariance[17] = before->covariance[17] + (p_0_6 * n_2);
            after->covariance[18] = before->covariance[18] + (p_0_3 * n_3);
            after->covariance[19] = before->covariance[19] + (p_0_4 * n_3);
            after->covariance[20] = before->covariance[20] + (p_0_5 * n_3);
            after->covariance[21] = before->covariance[21] + (p_0_6 * n_3);
            after->covariance[22] = before->covariance[22] + (p_0_4 * n_4);
            after->covariance[23] = before->covariance[23] + (p_0_5 * n_4);
            after->covariance[24] = before->covariance[24] + (p_0_6 * n_4);
            after->covariance[25] = before->covariance[25] + (p_0_5 * n_5);
            after->covariance[26] = before->covariance[26] + (p_0_6 * n_5);
            after->covariance[27] = before->covariance[27] + (p_0_6 * n_6);
            const float minus_e = -residual;
            delta[0] = n_0 * minus_e;
            delta[1] = n_1 * minus_e;
            delta[2] = n_2 * minus_e;
            delta[3] = n_3 * minus_e;
            delta[4] = n_4 * minus_e;
            delta[5] = n_5 * minus_e;
            delta[6] = n_6 * minus_e;
            nis[0] = residual * (residual * per_s);
            row_variance[0] = s;
        }

        if (!((row_variance[0] >= 1.0e-20f) == true))
        {
            status = QUADROTOR_REGULATOR_NOT_POSITIVE;
        }
        else
        {
            if (!(((nis[0] >= 0.0f) == true) && ((nis[0] <= 1.0e30f) == true)))
            {
                status = QUADROTOR_REGULATOR_OVERFLOW;
            }
            else
            {
                out->nis = nis[0];

                /* accepted? */
                if ((gate <= 0.0f) || (nis[0] <= gate))
                {
                    /* x = x + d */
                    after->w_reading[0] = before->w_reading[0] + delta[0];
                    after->w_reading[1] = before->w_reading[1] + delta[1];
                    after->w_reading[2] = before->w_reading[2] + delta[2];
                    after->w_reading[3] = before->w_reading[3] + delta[3];
                    after->w_reading[4] = before->w_reading[4] + delta[4];
                    after->w_reading[5] = before->w_reading[5] + delta[5];
                    after->w_reading[6] = before->w_reading[6] + delta[6];
                    after->rejected_reading = 0U;

                    /* judge, then commit */
                    if (!quadrotor_regulator_generator_x_is_bounded(after->covariance))
                    {
                        status = quadrotor_regulator_generator_x_hold_variances(after->covariance);
                    }
                    if (status >= QUADROTOR_REGULATOR_OK)
                    {
                        if (!(((after->w_reading[0] >= -1000000.0f) == true)
                              && ((after->w_reading[0] <= 1000000.0f) == true)
                              && ((after->w_reading[1] >= -1000000.0f) == true)
                              && ((after->w_reading[1] <= 1000000.0f) == true)
                              && ((after->w_reading[2] >= -1000000.0f) == true)
                              && ((after->w_reading[2] <= 1000000.0f) == true)
                              && ((after->w_reading[3] >= -1000000.0f) == true)
                              && ((after->w_reading[3] <= 1000000.0f) == true)
                              && ((after->w_reading[4] >= -1000000.0f) == true)
                              && ((after->w_reading[4] <= 1000000.0f) == true)
                              && ((after->w_reading[5] >= -1000000.0f) == true)
                              && ((after->w_reading[5] <= 1000000.0f) == true)
                              && ((after->w_reading[6] >= -1000000.0f) == true)
                              && ((after->w_reading[6] <= 1000000.0f) == true)))
                        {
                            status = QUADROTOR_REGULATOR_OVERFLOW;
                        }
                    }
                }
                else
                {
                    *after = *before;
                    if (after->rejected_reading < UINT32_MAX)
                    {
                        after->rejected_reading = after->rejected_reading + 1U;
                    }
                    status = quadrotor_regulator_higher(status, QUADROTOR_REGULATOR_GATED);
                }
            }
        }
    }
    return status;
}

/* 28 multiplications. */
static quadrotor_regulator_status_t quadrotor_regulator_generator_x_inflate_core(
    const quadrotor_regulator_generator_x_state_t *before, quadrotor_regulator_generator_x_state_t *after,
    const float factor)
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    for (uint32_t i = 0U; i < 7U; i++)
    {
        after->w_reading[i] = before->w_reading[i];
    }
    after->rejected_reading = before->rejected_reading;

    if (!(((factor >= 1.0f) == true) && ((factor <= 1000000.0f) == true)))
    {
        status = QUADROTOR_REGULATOR_BAD_INPUT;
    }
    else
    {
        /* P = factor P */
        for (uint32_t i = 0U; i < 28U; i++)
        {
            after->covariance[i] = factor * before->covariance[i];
        }

        /* judge, then commit */
        if (!quadrotor_regulator_generator_x_is_bounded(after->covariance))
        {
            status = quadrotor_regulator_generator_x_hold_variances(after->covariance);
        }
    }
    return status;
}

static quadrotor_regulator_status_t quadrotor_regulator_generator_x_step_core(
    const quadrotor_regulator_generator_x_state_t *before, quadrotor_regulator_generator_x_state_t *after,
    const quadrotor_regulator_generator_x_params_t *params, const bool has_reading, const float reading,
    quadrotor_regulator_generator_x_step_out_t *out)
{
    quadrotor_regulator_generator_x_state_t work[2];
    quadrotor_regulator_generator_x_state_t *latest = &work[0];
    quadrotor_regulator_generator_x_state_t *spare = after;
    quadrotor_regulator_status_t status = quadrotor_regulator_generator_x_predict_core(before, latest, params);

    if (status >= QUADROTOR_REGULATOR_OK)
    {
        /* reading */
        if (has_reading)
        {
            /* reading gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_reading >= params->reject_limit))
            {
                quadrotor_regulator_status_t own = quadrotor_regulator_generator_x_inflate_core(latest, &work[1],
                    params->inflation);
                quadrotor_regulator_status_t highest = status;

                if (own >= QUADROTOR_REGULATOR_OK)
                {
                    highest = quadrotor_regulator_higher(highest, own);
                    own = quadrotor_regulator_generator_x_update_reading_core(&work[1], spare, params, reading, 0.0f,
                        &out->reading);
                }
                out->status_reading = own;
                if (own >= QUADROTOR_REGULATOR_OK)
                {
                    latest = spare;
                    status = quadrotor_regulator_higher(highest, own);
                    status = quadrotor_regulator_higher(status, QUADROTOR_REGULATOR_RECOVERED);
                }
                else
                {
                    out->reading.innovation = 0.0f;
                    out->reading.variance = 0.0f;
                    out->reading.nis = 0.0f;
                    status = quadrotor_regulator_higher(status, QUADROTOR_REGULATOR_SKIPPED);
                }
            }
            else
            {
                quadrotor_regulator_status_t own = quadrotor_regulator_generator_x_update_reading_core(latest, spare,
                    params, reading, params->gate_reading, &out->reading);

                out->status_reading = own;
                if (own >= QUADROTOR_REGULATOR_OK)
                {
                    latest = spare;
                    status = quadrotor_regulator_higher(status, own);
                }
                else
                {
                    out->reading.innovation = 0.0f;
                    out->reading.variance = 0.0f;
                    out->reading.nis = 0.0f;
                    status = quadrotor_regulator_higher(status, QUADROTOR_REGULATOR_SKIPPED);
                }
            }
        }
        else
        {
            out->reading.innovation = 0.0f;
            out->reading.variance = 0.0f;
            out->reading.nis = 0.0f;
            out->status_reading = QUADROTOR_REGULATOR_OK;
        }
        if (latest != after)
        {
            *after = *latest;
        }
    }
    return status;
}

static quadrotor_regulator_status_t quadrotor_regulator_feedback_init_core(
    quadrotor_regulator_feedback_state_t *after, const quadrotor_regulator_feedback_params_t *params)
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    after->unused = 0U;
    if (!(((params->x >= -10000.0f) == true) && ((params->x <= 10000.0f) == true) && ((params->vx >= -10000.0f) == true)
          && ((params->vx <= 10000.0f) == true) && ((params->y >= -10000.0f) == true)
          && ((params->y <= 10000.0f) == true) && ((params->vy >= -10000.0f) == true)
          && ((params->vy <= 10000.0f) == true) && ((params->z >= -10000.0f) == true)
          && ((params->z <= 10000.0f) == true) && ((params->vz >= -10000.0f) == true)
          && ((params->vz <= 10000.0f) == true) && ((params->roll >= -30.0f) == true)
          && ((params->roll <= 30.0f) == true) && ((params->roll_rate >= -1000.0f) == true)
          && ((params->roll_rate <= 1000.0f) == true) && ((params->pitch >= -30.0f) == true)
          && ((params->pitch <= 30.0f) == true) && ((params->pitch_rate >= -1000.0f) == true)
          && ((params->pitch_rate <= 1000.0f) == true) && ((params->yaw >= -30.0f) == true)
          && ((params->yaw <= 30.0f) == true) && ((params->yaw_rate >= -1000.0f) == true)
          && ((params->yaw_rate <= 1000.0f) == true) && ((params->rotor_1 >= -10000.0f) == true)
          && ((params->rotor_1 <= 10000.0f) == true) && ((params->rotor_2 >= -10000.0f) == true)
          && ((params->rotor_2 <= 10000.0f) == true) && ((params->rotor_3 >= -10000.0f) == true)
          && ((params->rotor_3 <= 10000.0f) == true) && ((params->rotor_4 >= -10000.0f) == true)
          && ((params->rotor_4 <= 10000.0f) == true)))
    {
        status = QUADROTOR_REGULATOR_BAD_PARAM;
    }
    return status;
}

/* 86 additions, 20 multiplications, 2 negations. */
static quadrotor_regulator_status_t quadrotor_regulator_feedback_step_core(
    const quadrotor_regulator_feedback_state_t *before, quadrotor_regulator_feedback_state_t *after,
    const quadrotor_regulator_feedback_params_t *params, const float x, const float vx, const float y, const float vy,
    const float z, const float vz, const float roll, const float roll_rate, const float pitch, const float pitch_rate,
    const float yaw, const float yaw_rate, const float w_x[7], const float w_y[7], const float w_z[7],
    const float w_yaw[7], quadrotor_regulator_feedback_step_out_t *out)
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    after->unused = 0U;
    (void)before;
    if (!(((x >= -10000.0f) == true) && ((x <= 10000.0f) == true) && ((vx >= -10000.0f) == true)
          && ((vx <= 10000.0f) == true) && ((y >= -10000.0f) == true) && ((y <= 10000.0f) == true)
          && ((vy >= -10000.0f) == true) && ((vy <= 10000.0f) == true) && ((z >= -10000.0f) == true)
          && ((z <= 10000.0f) == true) && ((vz >= -10000.0f) == true) && ((vz <= 10000.0f) == true)
          && ((roll >= -30.0f) == true) && ((roll <= 30.0f) == true) && ((roll_rate >= -1000.0f) == true)
          && ((roll_rate <= 1000.0f) == true) && ((pitch >= -30.0f) == true) && ((pitch <= 30.0f) == true)
          && ((pitch_rate >= -1000.0f) == true) && ((pitch_rate <= 1000.0f) == true) && ((yaw >= -30.0f) == true)
          && ((yaw <= 30.0f) == true) && ((yaw_rate >= -1000.0f) == true) && ((yaw_rate <= 1000.0f) == true)))
    {
        status = QUADROTOR_REGULATOR_BAD_INPUT;
    }
    else
    {
        /* rotor_1 = rotor_1 + -0.0373001546 w_x[4] + 0.0373001546 w_y[4] + 10.8419116 w_z[2] + 7.58578985 w_yaw[2] -
         * (-4.13564904 (x - params.x - w_x[0]) + -6.44956949 (vx - params.vx - w_x[1]) + 4.13564904 (y - params.y -
         * w_y[0]) + 6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171 (vz -
         * params.vz - w_z[1]) + -28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + -6.32217889 (roll_rate -
         * params.roll_rate - -0.101936799 w_y[3]) + -28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) +
         * -6.32217889 (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + 4.93424116 (yaw - params.yaw -
         * w_yaw[0]) + 10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        /* rotor_2 = rotor_2 + 0.0373001546 w_x[4] + 0.0373001546 w_y[4] + 10.8419116 w_z[2] + -7.58578985 w_yaw[2] -
         * (4.13564904 (x - params.x - w_x[0]) + 6.44956949 (vx - params.vx - w_x[1]) + 4.13564904 (y - params.y -
         * w_y[0]) + 6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171 (vz -
         * params.vz - w_z[1]) + -28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + -6.32217889 (roll_rate -
         * params.roll_rate - -0.101936799 w_y[3]) + 28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) +
         * 6.32217889 (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + -4.93424116 (yaw - params.yaw -
         * w_yaw[0]) + -10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        /* rotor_3 = rotor_3 + 0.0373001546 w_x[4] + -0.0373001546 w_y[4] + 10.8419116 w_z[2] + 7.58578985 w_yaw[2] -
         * (4.13564904 (x - params.x - w_x[0]) + 6.44956949 (vx - params.vx - w_x[1]) + -4.13564904 (y - params.y -
         * w_y[0]) + -6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171 (vz -
         * params.vz - w_z[1]) + 28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + 6.32217889 (roll_rate -
         * params.roll_rate - -0.101936799 w_y[3]) + 28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) +
         * 6.32217889 (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + 4.93424116 (yaw - params.yaw -
         * w_yaw[0]) + 10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        /* rotor_4 = rotor_4 + -0.0373001546 w_x[4] + -0.0373001546 w_y[4] + 10.8419116 w_z[2] + -7.58578985 w_yaw[2]
         * - (-4.13564904 (x - params.x - w_x[0]) + -6.44956949 (vx - params.vx - w_x[1]) + -4.13564904 (y - params.y
         * - w_y[0]) + -6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z - w_z[0]) + 11.5275171 (vz -
         * params.vz - w_z[1]) + 28.4171267 (roll - params.roll - -0.101936799 w_y[2]) + 6.32217889 (roll_rate -
         * params.roll_rate - -0.101936799 w_y[3]) + -28.4171267 (pitch - params.pitch - 0.101936799 w_x[2]) +
         * -6.32217889 (pitch_rate - params.pitch_rate - 0.101936799 w_x[3]) + -4.93424116 (yaw - params.yaw -
         * w_yaw[0]) + -10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        const float v = w_y[4] * 0.037300155f;
        const float v_2 = w_x[4] * 0.037300155f;
        const float v_3 = w_z[2] * 10.841911f;
        const float v_4 = w_yaw[2] * 7.5857897f;
        const float v_5 = ((x - params->x) - w_x[0]) * 4.135649f;
        const float v_6 = ((vx - params->vx) - w_x[1]) * 6.4495697f;
        const float v_7 = (-v_5) - v_6;
        const float v_8 = 4.135649f * ((y - params->y) - w_y[0]);
        const float v_9 = 6.4495697f * ((vy - params->vy) - w_y[1]);
        const float v_10 = 4.947014f * ((z - params->z) - w_z[0]);
        const float v_11 = 11.527517f * ((vz - params->vz) - w_z[1]);
        const float v_12 = ((roll - params->roll) + (w_y[2] * 0.1019368f)) * 28.417128f;
        const float v_13 = ((roll_rate - params->roll_rate) + (w_y[3] * 0.1019368f)) * 6.322179f;
        const float v_14 = 28.417128f * ((pitch - params->pitch) - (w_x[2] * 0.1019368f));
        const float v_15 = 6.322179f * ((pitch_rate - params->pitch_rate) - (w_x[3] * 0.1019368f));
        const float v_16 = 4.9342413f * ((yaw - params->yaw) - w_yaw[0]);
        const float v_17 = 10.009734f * ((yaw_rate - params->yaw_rate) - w_yaw[1]);
        const float v_18 = (((((((((v_7 + v_8) + v_9) + v_10) + v_11) - v_12) - v_13) - v_14) - v_15) + v_16) + v_17;
        out->rotor_1 = params->rotor_1 + ((((v - v_2) + v_3) + v_4) - v_18);
        const float v_19 = v_5 + v_6;
        const float v_20 = ((v_15 + (v_14 + (((v_11 + (v_10 + (v_9 + (v_8 + v_19)))) - v_12) - v_13))) - v_16) - v_17;
        out->rotor_2 = params->rotor_2 + (((v_3 + (v_2 + v)) - v_4) - v_20);
        const float v_21 = v_17 + (v_16 + (v_15 + (v_14 + (v_13 + (v_12 + (v_11 + (v_10 + ((v_19 - v_8) - v_9))))))));
        out->rotor_3 = params->rotor_3 + ((v_4 + (v_3 + (v_2 - v))) - v_21);
        const float v_22 = ((((v_13 + (v_12 + (v_11 + (v_10 + ((v_7 - v_8) - v_9))))) - v_14) - v_15) - v_16) - v_17;
        out->rotor_4 = params->rotor_4 + (((v_3 + ((-v_2) - v)) - v_4) - v_22);

        if (!(((out->rotor_1 >= -10000.0f) == true) && ((out->rotor_1 <= 10000.0f) == true)))
        {
            status = QUADROTOR_REGULATOR_OVERFLOW;
        }
        else
        {
            if (!(((out->rotor_2 >= -10000.0f) == true) && ((out->rotor_2 <= 10000.0f) == true)))
            {
                status = QUADROTOR_REGULATOR_OVERFLOW;
            }
            else
            {
                if (!(((out->rotor_3 >= -10000.0f) == true) && ((out->rotor_3 <= 10000.0f) == true)))
                {
                    status = QUADROTOR_REGULATOR_OVERFLOW;
                }
                else
                {
                    if (!(((out->rotor_4 >= -10000.0f) == true) && ((out->rotor_4 <= 10000.0f) == true)))
                    {
                        status = QUADROTOR_REGULATOR_OVERFLOW;
                    }
                }
            }
        }
    }
    return status;
}

static quadrotor_regulator_status_t quadrotor_regulator_init_core(quadrotor_regulator_state_t *after,
                                                                  const quadrotor_regulator_params_t *params)
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    /* generator_x: generator, init */
    const quadrotor_regulator_status_t status_generator_x =
        quadrotor_regulator_generator_x_init_core(&after->generator_x, &params->generator_x);
    status = (status_generator_x < QUADROTOR_REGULATOR_OK) ? status_generator_x : quadrotor_regulator_higher(status,
        status_generator_x);
    if (status >= QUADROTOR_REGULATOR_OK)
    {
        /* generator_y: generator, init */
        const quadrotor_regulator_status_t status_generator_y =
            quadrotor_regulator_generator_x_init_core(&after->generator_y, &params->generator_y);
        status = (status_generator_y < QUADROTOR_REGULATOR_OK) ? status_generator_y : quadrotor_regulator_higher(status,
            status_generator_y);
        if (status >= QUADROTOR_REGULATOR_OK)
        {
            /* generator_z: generator, init */
            const quadrotor_regulator_status_t status_generator_z =
                quadrotor_regulator_generator_x_init_core(&after->generator_z, &params->generator_z);
            status = (status_generator_z < QUADROTOR_REGULATOR_OK) ? status_generator_z :
                quadrotor_regulator_higher(status, status_generator_z);
            if (status >= QUADROTOR_REGULATOR_OK)
            {
                /* generator_yaw: generator, init */
                const quadrotor_regulator_status_t status_generator_yaw =
                    quadrotor_regulator_generator_x_init_core(&after->generator_yaw, &params->generator_yaw);
                status = (status_generator_yaw < QUADROTOR_REGULATOR_OK) ? status_generator_yaw :
                    quadrotor_regulator_higher(status, status_generator_yaw);
                if (status >= QUADROTOR_REGULATOR_OK)
                {
                    /* feedback: quadrotor_feedback, init */
                    const quadrotor_regulator_status_t status_feedback =
                        quadrotor_regulator_feedback_init_core(&after->feedback, &params->feedback);
                    status = (status_feedback < QUADROTOR_REGULATOR_OK) ? status_feedback :
                        quadrotor_regulator_higher(status, status_feedback);
                }
            }
        }
    }
    return status;
}

static quadrotor_regulator_status_t quadrotor_regulator_step_core(const quadrotor_regulator_state_t *before,
                                                                  quadrotor_regulator_state_t *after,
                                                                  const quadrotor_regulator_params_t *params,
                                                                  const bool generator_x_has_reading,
                                                                  const float generator_x_reading,
                                                                  const bool generator_y_has_reading,
                                                                  const float generator_y_reading,
                                                                  const bool generator_z_has_reading,
                                                                  const float generator_z_reading,
                                                                  const bool generator_yaw_has_reading,
                                                                  const float generator_yaw_reading,
                                                                  const float feedback_x, const float feedback_vx,
                                                                  const float feedback_y, const float feedback_vy,
                                                                  const float feedback_z, const float feedback_vz,
                                                                  const float feedback_roll,
                                                                  const float feedback_roll_rate,
                                                                  const float feedback_pitch,
                                                                  const float feedback_pitch_rate,
                                                                  const float feedback_yaw,
                                                                  const float feedback_yaw_rate,
                                                                  quadrotor_regulator_step_out_t *out)
{
    quadrotor_regulator_status_t status = QUADROTOR_REGULATOR_OK;

    /* generator_x: generator, step */
    const quadrotor_regulator_status_t status_generator_x =
        quadrotor_regulator_generator_x_step_core(&before->generator_x, &after->generator_x, &params->generator_x,
        generator_x_has_reading, generator_x_reading, &out->generator_x);
    status = (status_generator_x < QUADROTOR_REGULATOR_OK) ? status_generator_x : quadrotor_regulator_higher(status,
        status_generator_x);
    if (status >= QUADROTOR_REGULATOR_OK)
    {
        /* generator_y: generator, step */
        const quadrotor_regulator_status_t status_generator_y =
            quadrotor_regulator_generator_x_step_core(&before->generator_y, &after->generator_y, &params->generator_y,
            generator_y_has_reading, generator_y_reading, &out->generator_y);
        status = (status_generator_y < QUADROTOR_REGULATOR_OK) ? status_generator_y : quadrotor_regulator_higher(status,
            status_generator_y);
        if (status >= QUADROTOR_REGULATOR_OK)
        {
            /* generator_z: generator, step */
            const quadrotor_regulator_status_t status_generator_z =
                quadrotor_regulator_generator_x_step_core(&before->generator_z, &after->generator_z,
                &params->generator_z, generator_z_has_reading, generator_z_reading, &out->generator_z);
            status = (status_generator_z < QUADROTOR_REGULATOR_OK) ? status_generator_z :
                quadrotor_regulator_higher(status, status_generator_z);
            if (status >= QUADROTOR_REGULATOR_OK)
            {
                /* generator_yaw: generator, step */
                const quadrotor_regulator_status_t status_generator_yaw =
                    quadrotor_regulator_generator_x_step_core(&before->generator_yaw, &after->generator_yaw,
                    &params->generator_yaw, generator_yaw_has_reading, generator_yaw_reading, &out->generator_yaw);
                status = (status_generator_yaw < QUADROTOR_REGULATOR_OK) ? status_generator_yaw :
                    quadrotor_regulator_higher(status, status_generator_yaw);
                if (status >= QUADROTOR_REGULATOR_OK)
                {
                    /* feedback: quadrotor_feedback, step */
                    const quadrotor_regulator_status_t status_feedback =
                        quadrotor_regulator_feedback_step_core(&before->feedback, &after->feedback, &params->feedback,
                        feedback_x, feedback_vx, feedback_y, feedback_vy, feedback_z, feedback_vz, feedback_roll,
                        feedback_roll_rate, feedback_pitch, feedback_pitch_rate, feedback_yaw, feedback_yaw_rate,
                        after->generator_x.w_reading, after->generator_y.w_reading, after->generator_z.w_reading,
                        after->generator_yaw.w_reading, &out->feedback);
                    status = (status_feedback < QUADROTOR_REGULATOR_OK) ? status_feedback :
                        quadrotor_regulator_higher(status, status_feedback);
                }
            }
        }
    }
    return status;
}

quadrotor_regulator_status_t quadrotor_regulator_init(quadrotor_regulator_state_t *state,
                                                      const quadrotor_regulator_params_t *params)
{
    quadrotor_regulator_state_t after;
    const quadrotor_regulator_status_t status = quadrotor_regulator_init_core(&after, params);

    if (status >= QUADROTOR_REGULATOR_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_regulator_status_t quadrotor_regulator_step(quadrotor_regulator_state_t *state,
                                                      const quadrotor_regulator_params_t *params,
                                                      const quadrotor_regulator_step_in_t *in,
                                                      quadrotor_regulator_step_out_t *out)
{
    quadrotor_regulator_state_t after;
    quadrotor_regulator_step_out_t answer;
    const quadrotor_regulator_status_t status = quadrotor_regulator_step_core(state, &after, params,
        in->generator_x_has_reading, in->generator_x_reading, in->generator_y_has_reading, in->generator_y_reading,
        in->generator_z_has_reading, in->generator_z_reading, in->generator_yaw_has_reading, in->generator_yaw_reading,
        in->feedback_x, in->feedback_vx, in->feedback_y, in->feedback_vy, in->feedback_z, in->feedback_vz,
        in->feedback_roll, in->feedback_roll_rate, in->feedback_pitch, in->feedback_pitch_rate, in->feedback_yaw,
        in->feedback_yaw_rate, &answer);

    if (status >= QUADROTOR_REGULATOR_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

/* The hash of the model, as in the header. */
const char *quadrotor_regulator_model(void)
{
    return "982acaf4";
}

/* A sentence for a status. */
const char *quadrotor_regulator_status_text(quadrotor_regulator_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case QUADROTOR_REGULATOR_OK:
            text = "ok";
            break;
        case QUADROTOR_REGULATOR_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case QUADROTOR_REGULATOR_CLAMPED:
            text = "a value (a variance, a command) was held at its limit";
            break;
        case QUADROTOR_REGULATOR_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case QUADROTOR_REGULATOR_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case QUADROTOR_REGULATOR_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case QUADROTOR_REGULATOR_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case QUADROTOR_REGULATOR_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case QUADROTOR_REGULATOR_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
