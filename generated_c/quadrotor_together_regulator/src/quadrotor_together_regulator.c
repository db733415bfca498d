/* quadrotor_together_regulator: see quadrotor_together_regulator.h. Written by plantc 0.1.0 from model 1eed9805. */
#include "quadrotor_together_regulator.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "quadrotor_together_regulator checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static quadrotor_together_regulator_status_t quadrotor_together_regulator_higher(quadrotor_together_regulator_status_t first, quadrotor_together_regulator_status_t second)
{
    return (first > second) ? first : second;
}

/* Whether every element is within its bounds; false for NaN. A comparison that decides what is stored is written
 * (... == true), from which Frama-C sees that NaN does not pass. */
static bool quadrotor_together_regulator_generator_is_held(const float covariance[28])
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
static quadrotor_together_regulator_status_t quadrotor_together_regulator_generator_hold_variances(float covariance[28])
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 7U; i++)
    {
        if (!((covariance[at] >= 0.0f) == true))
        {
            status = QUADROTOR_TOGETHER_REGULATOR_NOT_POSITIVE;
        }
        at = at + (7U - i);
    }
    at = 0U;
    for (uint32_t i = 0U; (i < 7U) && (status >= QUADROTOR_TOGETHER_REGULATOR_OK); i++)
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
            status = QUADROTOR_TOGETHER_REGULATOR_CLAMPED;
        }
        else if (covariance[at] < floor_i)
        {
            covariance[at] = floor_i;
            status = QUADROTOR_TOGETHER_REGULATOR_CLAMPED;
        }
        else
        {
            /* within its bounds */
        }
        at = at + (7U - i);
    }
    if ((status >= QUADROTOR_TOGETHER_REGULATOR_OK) && (!quadrotor_together_regulator_generator_is_held(covariance)))
    {
        status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
    }
    return status;
}

/* Whether a covariance is within its bounds beyond doubt. Elements that are small, and whose sum is not far below
 * zero, are not far below zero themselves. False for NaN. */
static bool quadrotor_together_regulator_generator_is_bounded(const float covariance[28])
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

static quadrotor_together_regulator_status_t quadrotor_together_regulator_generator_init_core(
    quadrotor_together_regulator_generator_state_t *after,
    const quadrotor_together_regulator_generator_params_t *params)
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

    if (!(((params->variance_step[0] >= 0.0f) == true) && ((params->variance_step[0] <= 1000000.0f) == true)
          && ((params->variance_step[1] >= 0.0f) == true) && ((params->variance_step[1] <= 1000000.0f) == true)
          && ((params->variance_step[2] >= 0.0f) == true) && ((params->variance_step[2] <= 1000000.0f) == true)
          && ((params->variance_step[3] >= 0.0f) == true) && ((params->variance_step[3] <= 1000000.0f) == true)
          && ((params->variance_step[4] >= 0.0f) == true) && ((params->variance_step[4] <= 1000000.0f) == true)
          && ((params->variance_step[5] >= 0.0f) == true) && ((params->variance_step[5] <= 1000000.0f) == true)
          && ((params->variance_step[6] >= 0.0f) == true) && ((params->variance_step[6] <= 1000000.0f) == true)
          && ((params->variance_readings >= 1.0e-12f) == true) && ((params->variance_readings <= 1000000.0f) == true)
          && ((params->gate_readings >= 0.0f) == true) && ((params->gate_readings <= 1000000.0f) == true)
          && ((params->inflation >= 1.0f) == true) && ((params->inflation <= 1000000.0f) == true)
          && ((params->variance_0[0] >= 1.0e-12f) == true) && ((params->variance_0[0] <= 1000000.0f) == true)
          && ((params->variance_0[1] >= 1.0e-12f) == true) && ((params->variance_0[1] <= 1000000.0f) == true)
          && ((params->variance_0[2] >= 1.0e-12f) == true) && ((params->variance_0[2] <= 1000000.0f) == true)
          && ((params->variance_0[3] >= 1.0e-12f) == true) && ((params->variance_0[3] <= 1000000.0f) == true)
          && ((params->variance_0[4] >= 1.0e-12f) == true) && ((params->variance_0[4] <= 1000000.0f) == true)
          && ((params->variance_0[5] >= 1.0e-12f) == true) && ((params->variance_0[5] <= 1000000.0f) == true)
          && ((params->variance_0[6] >= 1.0e-12f) == true) && ((params->variance_0[6] <= 1000000.0f) == true)))
    {
        status = QUADROTOR_TOGETHER_REGULATOR_BAD_PARAM;
    }
    else
    {
        for (uint32_t i = 0U; i < 7U; i++)
        {
            after->w_x[i] = 0.0f;
        }
        for (uint32_t i = 0U; i < 7U; i++)
        {
            after->w_y[i] = 0.0f;
        }
        for (uint32_t i = 0U; i < 7U; i++)
        {
            after->w_z[i] = 0.0f;
        }
        for (uint32_t i = 0U; i < 7U; i++)
        {
            after->w_yaw[i] = 0.0f;
        }
        for (uint32_t i = 0U; i < 28U; i++)
        {
            after->covariance[i] = 0.0f;
        }
        after->covariance[0] = params->variance_0[0];
        after->covariance[7] = params->variance_0[1];
        after->covariance[13] = params->variance_0[2];
        after->covariance[18] = params->variance_0[3];
        after->covariance[22] = params->variance_0[4];
        after->covariance[25] = params->variance_0[5];
        after->covariance[27] = params->variance_0[6];
        after->rejected_readings = 0U;

        /* judge, then commit */
        if (!quadrotor_together_regulator_generator_is_bounded(after->covariance))
        {
            status = quadrotor_together_regulator_generator_hold_variances(after->covariance);
        }
    }
    return status;
}

/* 79 additions, 67 multiplications. */
static quadrotor_together_regulator_status_t quadrotor_together_regulator_generator_predict_core(
    const quadrotor_together_regulator_generator_state_t *before, quadrotor_together_regulator_generator_state_t *after,
    const quadrotor_together_regulator_generator_params_t *params)
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

    after->rejected_readings = before->rejected_readings;

    /* w = S w, for each signal */
    const float w_x_1 = before->w_x[1];
    after->w_x[0] = before->w_x[0] + (w_x_1 * 0.02f);
    const float w_x_2 = before->w_x[2];
    after->w_x[1] = w_x_1 + (w_x_2 * 0.02f);
    const float w_x_3 = before->w_x[3];
    after->w_x[2] = w_x_2 + (w_x_3 * 0.02f);
    const float w_x_4 = before->w_x[4];
    after->w_x[3] = w_x_3 + (w_x_4 * 0.02f);
    const float w_x_5 = before->w_x[5];
    after->w_x[4] = w_x_4 + (w_x_5 * 0.02f);
    const float w_x_6 = before->w_x[6];
    after->w_x[5] = w_x_5 + (w_x_6 * 0.02f);
    after->w_x[6] = w_x_6;
    const float w_y_1 = before->w_y[1];
    after->w_y[0] = before->w_y[0] + (w_y_1 * 0.02f);
    const float w_y_2 = before->w_y[2];
    after->w_y[1] = w_y_1 + (w_y_2 * 0.02f);
    const float w_y_3 = before->w_y[3];
    after->w_y[2] = w_y_2 + (w_y_3 * 0.02f);
    const float w_y_4 = before->w_y[4];
    after->w_y[3] = w_y_3 + (w_y_4 * 0.02f);
    const float w_y_5 = before->w_y[5];
    after->w_y[4] = w_y_4 + (w_y_5 * 0.02f);
    const float w_y_6 = before->w_y[6];
    after->w_y[5] = w_y_5 + (w_y_6 * 0.02f);
    after->w_y[6] = w_y_6;
    const float w_z_1 = before->w_z[1];
    after->w_z[0] = before->w_z[0] + (w_z_1 * 0.02f);
    const float w_z_2 = before->w_z[2];
    after->w_z[1] = w_z_1 + (w_z_2 * 0.02f);
    const float w_z_3 = before->w_z[3];
    after->w_z[2] = w_z_2 + (w_z_3 * 0.02f);
    const float w_z_4 = before->w_z[4];
    after->w_z[3] = w_z_3 + (w_z_4 * 0.02f);
    const float w_z_5 = before->w_z[5];
    after->w_z[4] = w_z_4 + (w_z_5 * 0.02f);
    const float w_z_6 = before->w_z[6];
    after->w_z[5] = w_z_5 + (w_z_6 * 0.02f);
    after->w_z[6] = w_z_6;
    const float w_yaw_1 = before->w_yaw[1];
    after->w_yaw[0] = before->w_yaw[0] + (w_yaw_1 * 0.02f);
    const float w_yaw_2 = before->w_yaw[2];
    after->w_yaw[1] = w_yaw_1 + (w_yaw_2 * 0.02f);
    const float w_yaw_3 = before->w_yaw[3];
    after->w_yaw[2] = w_yaw_2 + (w_yaw_3 * 0.02f);
    const float w_yaw_4 = before->w_yaw[4];
    after->w_yaw[3] = w_yaw_3 + (w_yaw_4 * 0.02f);
    const float w_yaw_5 = before->w_yaw[5];
    after->w_yaw[4] = w_yaw_4 + (w_yaw_5 * 0.02f);
    const float w_yaw_6 = before->w_yaw[6];
    after->w_yaw[5] = w_yaw_5 + (w_yaw_6 * 0.02f);
    after->w_yaw[6] = w_yaw_6;

    /* P = F P F' + Q */
    {
        const float p_0_1 = before->covariance[1];
        const float p_1_1 = before->covariance[7];
        const float v = p_0_1 + (0.02f * p_1_1);
        after->covariance[0] = params->variance_step[0] + ((before->covariance[0] + (0.02f * p_0_1)) + (0.02f * v));
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
        after->covariance[7] = params->variance_step[1] + ((p_1_1 + v_2) + (0.02f * v_8));
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
        after->covariance[13] = params->variance_step[2] + ((p_2_2 + v_9) + (0.02f * v_14));
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
        after->covariance[18] = params->variance_step[3] + ((p_3_3 + v_15) + (0.02f * v_19));
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
        after->covariance[22] = params->variance_step[4] + ((p_4_4 + v_20) + (0.02f * v_23));
        const float p_5_6 = before->covariance[26];
        const float v_24 = 0.02f * p_5_6;
        const float v_25 = p_4_6 + v_24;
        after->covariance[23] = v_23 + (0.02f * v_25);
        after->covariance[24] = v_25;
        const float p_6_6 = before->covariance[27];
        const float v_26 = p_5_6 + (0.02f * p_6_6);
        after->covariance[25] = params->variance_step[5] + ((p_5_5 + v_24) + (0.02f * v_26));
        after->covariance[26] = v_26;
        after->covariance[27] = params->variance_step[6] + p_6_6;
    }

    /* judge, then commit */
    if (!quadrotor_together_regulator_generator_is_bounded(after->covariance))
    {
        status = quadrotor_together_regulator_generator_hold_variances(after->covariance);
    }
    if (status >= QUADROTOR_TOGETHER_REGULATOR_OK)
    {
        if (!(((after->w_x[0] >= -1000000.0f) == true) && ((after->w_x[0] <= 1000000.0f) == true)
              && ((after->w_x[1] >= -1000000.0f) == true) && ((after->w_x[1] <= 1000000.0f) == true)
              && ((after->w_x[2] >= -1000000.0f) == true) && ((after->w_x[2] <= 1000000.0f) == true)
              && ((after->w_x[3] >= -1000000.0f) == true) && ((after->w_x[3] <= 1000000.0f) == true)
              && ((after->w_x[4] >= -1000000.0f) == true) && ((after->w_x[4] <= 1000000.0f) == true)
              && ((after->w_x[5] >= -1000000.0f) == true) && ((after->w_x[5] <= 1000000.0f) == true)
              && ((after->w_x[6] >= -1000000.0f) == true) && ((after->w_x[6] <= 1000000.0f) == true)
              && ((after->w_y[0] >= -1000000.0f) == true) && ((after->w_y[0] <= 1000000.0f) == true)
              && ((after->w_y[1] >= -1000000.0f) == true) && ((after->w_y[1] <= 1000000.0f) == true)
              && ((after->w_y[2] >= -1000000.0f) == true) && ((after->w_y[2] <= 1000000.0f) == true)
              && ((after->w_y[3] >= -1000000.0f) == true) && ((after->w_y[3] <= 1000000.0f) == true)
              && ((after->w_y[4] >= -1000000.0f) == true) && ((after->w_y[4] <= 1000000.0f) == true)
              && ((after->w_y[5] >= -1000000.0f) == true) && ((after->w_y[5] <= 1000000.0f) == true)
              && ((after->w_y[6] >= -1000000.0f) == true) && ((after->w_y[6] <= 1000000.0f) == true)
              && ((after->w_z[0] >= -1000000.0f) == true) && ((after->w_z[0] <= 1000000.0f) == true)
              && ((after->w_z[1] >= -1000000.0f) == true) && ((after->w_z[1] <= 1000000.0f) == true)
              && ((after->w_z[2] >= -1000000.0f) == true) && ((after->w_z[2] <= 1000000.0f) == true)
              && ((after->w_z[3] >= -1000000.0f) == true) && ((after->w_z[3] <= 1000000.0f) == true)
              && ((after->w_z[4] >= -1000000.0f) == true) && ((after->w_z[4] <= 1000000.0f) == true)
              && ((after->w_z[5] >= -1000000.0f) == true) && ((after->w_z[5] <= 1000000.0f) == true)
              && ((after->w_z[6] >= -1000000.0f) == true) && ((after->w_z[6] <= 1000000.0f) == true)
              && ((after->w_yaw[0] >= -1000000.0f) == true) && ((after->w_yaw[0] <= 1000000.0f) == true)
              && ((after->w_yaw[1] >= -1000000.0f) == true) && ((after->w_yaw[1] <= 1000000.0f) == true)
              && ((after->w_yaw[2] >= -1000000.0f) == true) && ((after->w_yaw[2] <= 1000000.0f) == true)
              && ((after->w_yaw[3] >= -1000000.0f) == true) && ((after->w_yaw[3] <= 1000000.0f) == true)
              && ((after->w_yaw[4] >= -1000000.0f) == true) && ((after->w_yaw[4] <= 1000000.0f) == true)
              && ((after->w_yaw[5] >= -1000000.0f) == true) && ((after->w_yaw[5] <= 1000000.0f) == true)
              && ((after->w_yaw[6] >= -1000000.0f) == true) && ((after->w_yaw[6] <= 1000000.0f) == true)))
        {
            status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
        }
    }
    return status;
}

/* 58 additions, 71 multiplications, 1 division, 9 negations, 1 selection. */
static quadrotor_together_regulator_status_t quadrotor_together_regulator_generator_update_readings_core(
    const quadrotor_together_regulator_generator_state_t *before, quadrotor_together_regulator_generator_state_t *after,
    const quadrotor_together_regulator_generator_params_t *params, const float readings[4], const float gate,
    quadrotor_together_regulator_generator_update_readings_out_t *out)
{
    float delta[7];
    float nis[1];
    float row_variance[1];
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

    if (!(((readings[0] >= -10.0f) == true) && ((readings[0] <= 10.0f) == true) && ((readings[1] >= -10.0f) == true)
          && ((readings[1] <= 10.0f) == true) && ((readings[2] >= -10.0f) == true) && ((readings[2] <= 10.0f) == true)
          && ((readings[3] >= -10.0f) == true) && ((readings[3] <= 10.0f) == true)))
    {
        status = QUADROTOR_TOGETHER_REGULATOR_BAD_INPUT;
    }
    else
    {
        /* residual = reading - Q w, for each signal */
        const float residual_0 = readings[0] - before->w_x[0];
        const float residual_1 = readings[1] - before->w_y[0];
        const float residual_2 = readings[2] - before->w_z[0];
        const float residual_3 = readings[3] - before->w_yaw[0];

        /* variance of the innovation: diagonal of H P H' + R */
        {
            out->variance = params->variance_readings + before->covariance[0];
        }
        out->innovation[0] = residual_0;
        out->innovation[1] = residual_1;
        out->innovation[2] = residual_2;
        out->innovation[3] = residual_3;

        /* gain K = P h' / s, of each signal alike; P = P - K s K' */
        {
            const float p_0_0 = before->covariance[0];
            const float r_0 = params->variance_readings;
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
            delta[0] = -n_0;
            delta[1] = -n_1;
            delta[2] = -n_2;
            delta[3] = -n_3;
            delta[4] = -n_4;
            delta[5] = -n_5;
            delta[6] = -n_6;
            nis[0] = per_s;
            row_variance[0] = s;
        }

        if (!((row_variance[0] >= 1.0e-20f) == true))
        {
            status = QUADROTOR_TOGETHER_REGULATOR_NOT_POSITIVE;
        }
        else
        {
            /* NIS of all readings */
            const float nis_0 = nis[0];
            const float v = ((residual_0 * (residual_0 * nis_0)) + (residual_1 * (residual_1 * nis_0))) + (residual_2 *
                (residual_2 * nis_0));
            const float total = v + (residual_3 * (residual_3 * nis_0));

            if (!(((total >= 0.0f) == true) && ((total <= 1.0e30f) == true)))
            {
                status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
            }
            else
            {
                out->nis = total;

                /* accepted? */
                if ((gate <= 0.0f) || (total <= gate))
                {
                    /* w = w + K e, for each signal */
                    const float delta_0 = delta[0];
                    after->w_x[0] = before->w_x[0] + (residual_0 * delta_0);
                    const float delta_1 = delta[1];
                    after->w_x[1] = before->w_x[1] + (residual_0 * delta_1);
                    const float delta_2 = delta[2];
                    after->w_x[2] = before->w_x[2] + (residual_0 * delta_2);
                    const float delta_3 = delta[3];
                    after->w_x[3] = before->w_x[3] + (residual_0 * delta_3);
                    const float delta_4 = delta[4];
                    after->w_x[4] = before->w_x[4] + (residual_0 * delta_4);
                    const float delta_5 = delta[5];
                    after->w_x[5] = before->w_x[5] + (residual_0 * delta_5);
                    const float delta_6 = delta[6];
                    after->w_x[6] = before->w_x[6] + (residual_0 * delta_6);
                    after->w_y[0] = before->w_y[0] + (residual_1 * delta_0);
                    after->w_y[1] = before->w_y[1] + (residual_1 * delta_1);
                    after->w_y[2] = before->w_y[2] + (residual_1 * delta_2);
                    after->w_y[3] = before->w_y[3] + (residual_1 * delta_3);
                    after->w_y[4] = before->w_y[4] + (residual_1 * delta_4);
                    after->w_y[5] = before->w_y[5] + (residual_1 * delta_5);
                    after->w_y[6] = before->w_y[6] + (residual_1 * delta_6);
                    after->w_z[0] = before->w_z[0] + (residual_2 * delta_0);
                    after->w_z[1] = before->w_z[1] + (residual_2 * delta_1);
                    after->w_z[2] = before->w_z[2] + (residual_2 * delta_2);
                    after->w_z[3] = before->w_z[3] + (residual_2 * delta_3);
                    after->w_z[4] = before->w_z[4] + (residual_2 * delta_4);
                    after->w_z[5] = before->w_z[5] + (residual_2 * delta_5);
                    after->w_z[6] = before->w_z[6] + (residual_2 * delta_6);
                    after->w_yaw[0] = before->w_yaw[0] + (residual_3 * delta_0);
                    after->w_yaw[1] = before->w_yaw[1] + (residual_3 * delta_1);
                    after->w_yaw[2] = before->w_yaw[2] + (residual_3 * delta_2);
                    after->w_yaw[3] = before->w_yaw[3] + (residual_3 * delta_3);
                    after->w_yaw[4] = before->w_yaw[4] + (residual_3 * delta_4);
                    after->w_yaw[5] = before->w_yaw[5] + (residual_3 * delta_5);
                    after->w_yaw[6] = before->w_yaw[6] + (residual_3 * delta_6);
                    after->rejected_readings = 0U;

                    /* judge, then commit */
                    if (!quadrotor_together_regulator_generator_is_bounded(after->covariance))
                    {
                        status = quadrotor_together_regulator_generator_hold_variances(after->covariance);
                    }
                    if (status >= QUADROTOR_TOGETHER_REGULATOR_OK)
                    {
                        if (!(((after->w_x[0] >= -1000000.0f) == true) && ((after->w_x[0] <= 1000000.0f) == true)
                              && ((after->w_x[1] >= -1000000.0f) == true) && ((after->w_x[1] <= 1000000.0f) == true)
                              && ((after->w_x[2] >= -1000000.0f) == true) && ((after->w_x[2] <= 1000000.0f) == true)
                              && ((after->w_x[3] >= -1000000.0f) == true) && ((after->w_x[3] <= 1000000.0f) == true)
                              && ((after->w_x[4] >= -1000000.0f) == true) && ((after->w_x[4] <= 1000000.0f) == true)
                              && ((after->w_x[5] >= -1000000.0f) == true) && ((after->w_x[5] <= 1000000.0f) == true)
                              && ((after->w_x[6] >= -1000000.0f) == true) && ((after->w_x[6] <= 1000000.0f) == true)
                              && ((after->w_y[0] >= -1000000.0f) == true) && ((after->w_y[0] <= 1000000.0f) == true)
                              && ((after->w_y[1] >= -1000000.0f) == true) && ((after->w_y[1] <= 1000000.0f) == true)
                              && ((after->w_y[2] >= -1000000.0f) == true) && ((after->w_y[2] <= 1000000.0f) == true)
                              && ((after->w_y[3] >= -1000000.0f) == true) && ((after->w_y[3] <= 1000000.0f) == true)
                              && ((after->w_y[4] >= -1000000.0f) == true) && ((after->w_y[4] <= 1000000.0f) == true)
                              && ((after->w_y[5] >= -1000000.0f) == true) && ((after->w_y[5] <= 1000000.0f) == true)
                              && ((after->w_y[6] >= -1000000.0f) == true) && ((after->w_y[6] <= 1000000.0f) == true)
                              && ((after->w_z[0] >= -1000000.0f) == true) && ((after->w_z[0] <= 1000000.0f) == true)
                              && ((after->w_z[1] >= -1000000.0f) == true) && ((after->w_z[1] <= 1000000.0f) == true)
                              && ((after->w_z[2] >= -1000000.0f) == true) && ((after->w_z[2] <= 1000000.0f) == true)
                              && ((after->w_z[3] >= -1000000.0f) == true) && ((after->w_z[3] <= 1000000.0f) == true)
                              && ((after->w_z[4] >= -1000000.0f) == true) && ((after->w_z[4] <= 1000000.0f) == true)
                              && ((after->w_z[5] >= -1000000.0f) == true) && ((after->w_z[5] <= 1000000.0f) == true)
                              && ((after->w_z[6] >= -1000000.0f) == true) && ((after->w_z[6] <= 1000000.0f) == true)
                              && ((after->w_yaw[0] >= -1000000.0f) == true) && ((after->w_yaw[0] <= 1000000.0f) == true)
                              && ((after->w_yaw[1] >= -1000000.0f) == true) && ((after->w_yaw[1] <= 1000000.0f) == true)
                              && ((after->w_yaw[2] >= -1000000.0f) == true) && ((after->w_yaw[2] <= 1000000.0f) == true)
                              && ((after->w_yaw[3] >= -1000000.0f) == true) && ((after->w_yaw[3] <= 1000000.0f) == true)
                              && ((after->w_yaw[4] >= -1000000.0f) == true) && ((after->w_yaw[4] <= 1000000.0f) == true)
                              && ((after->w_yaw[5] >= -1000000.0f) == true) && ((after->w_yaw[5] <= 1000000.0f) == true)
                              && ((after->w_yaw[6] >= -1000000.0f) == true)
                              && ((after->w_yaw[6] <= 1000000.0f) == true)))
                        {
                            status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
                        }
                    }
                }
                else
                {
                    *after = *before;
                    if (after->rejected_readings < UINT32_MAX)
                    {
                        after->rejected_readings = after->rejected_readings + 1U;
                    }
                    status = quadrotor_together_regulator_higher(status, QUADROTOR_TOGETHER_REGULATOR_GATED);
                }
            }
        }
    }
    return status;
}

/* 28 multiplications. */
static quadrotor_together_regulator_status_t quadrotor_together_regulator_generator_inflate_core(
    const quadrotor_together_regulator_generator_state_t *before, quadrotor_together_regulator_generator_state_t *after,
    const float factor)
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

    for (uint32_t i = 0U; i < 7U; i++)
    {
        after->w_x[i] = before->w_x[i];
    }
    for (uint32_t i = 0U; i < 7U; i++)
    {
        after->w_y[i] = before->w_y[i];
    }
    for (uint32_t i = 0U; i < 7U; i++)
    {
        after->w_z[i] = before->w_z[i];
    }
    for (uint32_t i = 0U; i < 7U; i++)
    {
        after->w_yaw[i] = before->w_yaw[i];
    }
    after->rejected_readings = before->rejected_readings;

    if (!(((factor >= 1.0f) == true) && ((factor <= 1000000.0f) == true)))
    {
        status = QUADROTOR_TOGETHER_REGULATOR_BAD_INPUT;
    }
    else
    {
        /* P = factor P */
        for (uint32_t i = 0U; i < 28U; i++)
        {
            after->covariance[i] = factor * before->covariance[i];
        }

        /* judge, then commit */
        if (!quadrotor_together_regulator_generator_is_bounded(after->covariance))
        {
            status = quadrotor_together_regulator_generator_hold_variances(after->covariance);
        }
    }
    return status;
}

static quadrotor_together_regulator_status_t quadrotor_together_regulator_generator_step_core(
    const quadrotor_together_regulator_generator_state_t *before, quadrotor_together_regulator_generator_state_t *after,
    const quadrotor_together_regulator_generator_params_t *params, const bool has_readings, const float readings[4],
    quadrotor_together_regulator_generator_step_out_t *out)
{
    quadrotor_together_regulator_generator_state_t work[2];
    quadrotor_together_regulator_generator_state_t *latest = &work[0];
    quadrotor_together_regulator_generator_state_t *spare = after;
    quadrotor_together_regulator_status_t status = quadrotor_together_regulator_generator_predict_core(before, latest,
        params);

    if (status >= QUADROTOR_TOGETHER_REGULATOR_OK)
    {
        /* readings */
        if (has_readings)
        {
            /* readings gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_readings >= params->reject_limit))
            {
                quadrotor_together_regulator_status_t own = quadrotor_together_regulator_generator_inflate_core(latest,
                    &work[1], params->inflation);
                quadrotor_together_regulator_status_t highest = status;

                if (own >= QUADROTOR_TOGETHER_REGULATOR_OK)
                {
                    highest = quadrotor_together_regulator_higher(highest, own);
                    own = quadrotor_together_regulator_generator_update_readings_core(&work[1], spare, params, readings,
                        0.0f, &out->readings);
                }
                out->status_readings = own;
                if (own >= QUADROTOR_TOGETHER_REGULATOR_OK)
                {
                    latest = spare;
                    status = quadrotor_together_regulator_higher(highest, own);
                    status = quadrotor_together_regulator_higher(status, QUADROTOR_TOGETHER_REGULATOR_RECOVERED);
                }
                else
                {
                    out->readings.innovation[0] = 0.0f;
                    out->readings.innovation[1] = 0.0f;
                    out->readings.innovation[2] = 0.0f;
                    out->readings.innovation[3] = 0.0f;
                    out->readings.variance = 0.0f;
                    out->readings.nis = 0.0f;
                    status = quadrotor_together_regulator_higher(status, QUADROTOR_TOGETHER_REGULATOR_SKIPPED);
                }
            }
            else
            {
                quadrotor_together_regulator_status_t own =
                    quadrotor_together_regulator_generator_update_readings_core(latest, spare, params, readings,
                    params->gate_readings, &out->readings);

                out->status_readings = own;
                if (own >= QUADROTOR_TOGETHER_REGULATOR_OK)
                {
                    latest = spare;
                    status = quadrotor_together_regulator_higher(status, own);
                }
                else
                {
                    out->readings.innovation[0] = 0.0f;
                    out->readings.innovation[1] = 0.0f;
                    out->readings.innovation[2] = 0.0f;
                    out->readings.innovation[3] = 0.0f;
                    out->readings.variance = 0.0f;
                    out->readings.nis = 0.0f;
                    status = quadrotor_together_regulator_higher(status, QUADROTOR_TOGETHER_REGULATOR_SKIPPED);
                }
            }
        }
        else
        {
            out->readings.innovation[0] = 0.0f;
            out->readings.innovation[1] = 0.0f;
            out->readings.innovation[2] = 0.0f;
            out->readings.innovation[3] = 0.0f;
            out->readings.variance = 0.0f;
            out->readings.nis = 0.0f;
            out->status_readings = QUADROTOR_TOGETHER_REGULATOR_OK;
        }
        if (latest != after)
        {
            *after = *latest;
        }
    }
    return status;
}

static quadrotor_together_regulator_status_t quadrotor_together_regulator_feedback_init_core(
    quadrotor_together_regulator_feedback_state_t *after, const quadrotor_together_regulator_feedback_params_t *params)
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

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
        status = QUADROTOR_TOGETHER_REGULATOR_BAD_PARAM;
    }
    return status;
}

/* 86 additions, 20 multiplications, 2 negations. */
static quadrotor_together_regulator_status_t quadrotor_together_regulator_feedback_step_core(
    const quadrotor_together_regulator_feedback_state_t *before, quadrotor_together_regulator_feedback_state_t *after,
    const quadrotor_together_regulator_feedback_params_t *params, const float x, const float vx, const float y,
    const float vy, const float z, const float vz, const float roll, const float roll_rate, const float pitch,
    const float pitch_rate, const float yaw, const float yaw_rate, const float w_x[7], const float w_y[7],
    const float w_z[7], const float w_yaw[7], quadrotor_together_regulator_feedback_step_out_t *out)
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

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
        status = QUADROTOR_TOGETHER_REGULATOR_BAD_INPUT;
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
            status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
        }
        else
        {
            if (!(((out->rotor_2 >= -10000.0f) == true) && ((out->rotor_2 <= 10000.0f) == true)))
            {
                status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
            }
            else
            {
                if (!(((out->rotor_3 >= -10000.0f) == true) && ((out->rotor_3 <= 10000.0f) == true)))
                {
                    status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
                }
                else
                {
                    if (!(((out->rotor_4 >= -10000.0f) == true) && ((out->rotor_4 <= 10000.0f) == true)))
                    {
                        status = QUADROTOR_TOGETHER_REGULATOR_OVERFLOW;
                    }
                }
            }
        }
    }
    return status;
}

static quadrotor_together_regulator_status_t quadrotor_together_regulator_init_core(
    quadrotor_together_regulator_state_t *after, const quadrotor_together_regulator_params_t *params)
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

    /* generator: generator, init */
    const quadrotor_together_regulator_status_t status_generator =
        quadrotor_together_regulator_generator_init_core(&after->generator, &params->generator);
    status = (status_generator < QUADROTOR_TOGETHER_REGULATOR_OK) ? status_generator :
        quadrotor_together_regulator_higher(status, status_generator);
    if (status >= QUADROTOR_TOGETHER_REGULATOR_OK)
    {
        /* feedback: quadrotor_feedback, init */
        const quadrotor_together_regulator_status_t status_feedback =
            quadrotor_together_regulator_feedback_init_core(&after->feedback, &params->feedback);
        status = (status_feedback < QUADROTOR_TOGETHER_REGULATOR_OK) ? status_feedback :
            quadrotor_together_regulator_higher(status, status_feedback);
    }
    return status;
}

static quadrotor_together_regulator_status_t quadrotor_together_regulator_step_core(
    const quadrotor_together_regulator_state_t *before, quadrotor_together_regulator_state_t *after,
    const quadrotor_together_regulator_params_t *params, const bool generator_has_readings,
    const float generator_readings[4], const float feedback_x, const float feedback_vx, const float feedback_y,
    const float feedback_vy, const float feedback_z, const float feedback_vz, const float feedback_roll,
    const float feedback_roll_rate, const float feedback_pitch, const float feedback_pitch_rate,
    const float feedback_yaw, const float feedback_yaw_rate, quadrotor_together_regulator_step_out_t *out)
{
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

    /* generator: generator, step */
    const quadrotor_together_regulator_status_t status_generator =
        quadrotor_together_regulator_generator_step_core(&before->generator, &after->generator, &params->generator,
        generator_has_readings, generator_readings, &out->generator);
    status = (status_generator < QUADROTOR_TOGETHER_REGULATOR_OK) ? status_generator :
        quadrotor_together_regulator_higher(status, status_generator);
    if (status >= QUADROTOR_TOGETHER_REGULATOR_OK)
    {
        /* feedback: quadrotor_feedback, step */
        const quadrotor_together_regulator_status_t status_feedback =
            quadrotor_together_regulator_feedback_step_core(&before->feedback, &after->feedback, &params->feedback,
            feedback_x, feedback_vx, feedback_y, feedback_vy, feedback_z, feedback_vz, feedback_roll,
            feedback_roll_rate, feedback_pitch, feedback_pitch_rate, feedback_yaw, feedback_yaw_rate,
            after->generator.w_x, after->generator.w_y, after->generator.w_z, after->generator.w_yaw, &out->feedback);
        status = (status_feedback < QUADROTOR_TOGETHER_REGULATOR_OK) ? status_feedback :
            quadrotor_together_regulator_higher(status, status_feedback);
    }
    return status;
}

quadrotor_together_regulator_status_t quadrotor_together_regulator_init(
    quadrotor_together_regulator_state_t *state, const quadrotor_together_regulator_params_t *params)
{
    quadrotor_together_regulator_state_t after;
    const quadrotor_together_regulator_status_t status = quadrotor_together_regulator_init_core(&after, params);

    if (status >= QUADROTOR_TOGETHER_REGULATOR_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_together_regulator_status_t quadrotor_together_regulator_step(
    quadrotor_together_regulator_state_t *state, const quadrotor_together_regulator_params_t *params,
    const quadrotor_together_regulator_step_in_t *in, quadrotor_together_regulator_step_out_t *out)
{
    quadrotor_together_regulator_state_t after;
    quadrotor_together_regulator_step_out_t answer;
    const quadrotor_together_regulator_status_t status = quadrotor_together_regulator_step_core(state, &after, params,
        in->generator_has_readings, in->generator_readings, in->feedback_x, in->feedback_vx, in->feedback_y,
        in->feedback_vy, in->feedback_z, in->feedback_vz, in->feedback_roll, in->feedback_roll_rate, in->feedback_pitch,
        in->feedback_pitch_rate, in->feedback_yaw, in->feedback_yaw_rate, &answer);

    if (status >= QUADROTOR_TOGETHER_REGULATOR_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

/* The hash of the model, as in the header. */
const char *quadrotor_together_regulator_model(void)
{
    return "1eed9805";
}

/* A sentence for a status. */
const char *quadrotor_together_regulator_status_text(quadrotor_together_regulator_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case QUADROTOR_TOGETHER_REGULATOR_OK:
            text = "ok";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_CLAMPED:
            text = "a value (a variance, a command) was held at its limit";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case QUADROTOR_TOGETHER_REGULATOR_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
