/* quadrotor_kf: see quadrotor_kf.h. Written by plantc 0.1.0 from model e2e766d7. */
#include "quadrotor_kf.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "quadrotor_kf checks for NaN and infinity: do not build it with -ffast-math"
#endif

static quadrotor_kf_status_t quadrotor_kf_higher(quadrotor_kf_status_t first, quadrotor_kf_status_t second)
{
    return (first > second) ? first : second;
}

/* Keeps the variances between floor and ceiling; called only when one is outside. Scaling row and column together keeps
 * the matrix positive definite. */
static quadrotor_kf_status_t quadrotor_kf_hold_variances(double covariance[78])
{
    quadrotor_kf_status_t status = QUADROTOR_KF_OK;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 12U; i++)
    {
        if (!(covariance[at] > 0.0))
        {
            status = QUADROTOR_KF_NOT_POSITIVE;
        }
        at = at + (12U - i);
    }
    at = 0U;
    for (uint32_t i = 0U; (i < 12U) && (status >= QUADROTOR_KF_OK); i++)
    {
        const double floor_i = 1.0e-20;
        const double ceiling_i = 1.0e9;

        if (covariance[at] > ceiling_i)
        {
            const double factor = sqrt(ceiling_i / covariance[at]);
            uint32_t other = i;

            for (uint32_t j = 0U; j < i; j++)
            {
                covariance[other] = covariance[other] * factor;
                other = other + ((12U - 1U) - j);
            }
            for (uint32_t j = i + 1U; j < 12U; j++)
            {
                covariance[at + (j - i)] = covariance[at + (j - i)] * factor;
            }
            covariance[at] = ceiling_i;
            status = QUADROTOR_KF_CLAMPED;
        }
        else if (covariance[at] < floor_i)
        {
            covariance[at] = floor_i;
            status = QUADROTOR_KF_CLAMPED;
        }
        else
        {
            /* within its bounds */
        }
        at = at + (12U - i);
    }
    return status;
}

static quadrotor_kf_status_t quadrotor_kf_init_core(quadrotor_kf_state_t *after, const quadrotor_kf_params_t *params)
{
    quadrotor_kf_status_t status = QUADROTOR_KF_OK;

    if (!((params->variance_step_x >= 0.0) && (params->variance_step_x <= 1000000.0)
          && (params->variance_step_vx >= 0.0) && (params->variance_step_vx <= 1000000.0)
          && (params->variance_step_y >= 0.0) && (params->variance_step_y <= 1000000.0)
          && (params->variance_step_vy >= 0.0) && (params->variance_step_vy <= 1000000.0)
          && (params->variance_step_z >= 0.0) && (params->variance_step_z <= 1000000.0)
          && (params->variance_step_vz >= 0.0) && (params->variance_step_vz <= 1000000.0)
          && (params->variance_step_roll >= 0.0) && (params->variance_step_roll <= 1000000.0)
          && (params->variance_step_roll_rate >= 0.0) && (params->variance_step_roll_rate <= 1000000.0)
          && (params->variance_step_pitch >= 0.0) && (params->variance_step_pitch <= 1000000.0)
          && (params->variance_step_pitch_rate >= 0.0) && (params->variance_step_pitch_rate <= 1000000.0)
          && (params->variance_step_yaw >= 0.0) && (params->variance_step_yaw <= 1000000.0)
          && (params->variance_step_yaw_rate >= 0.0) && (params->variance_step_yaw_rate <= 1000000.0)
          && (params->variance_pose[0] >= 1.0e-12) && (params->variance_pose[0] <= 1000000.0)
          && (params->variance_pose[1] >= 1.0e-12) && (params->variance_pose[1] <= 1000000.0)
          && (params->variance_pose[2] >= 1.0e-12) && (params->variance_pose[2] <= 1000000.0)
          && (params->variance_pose[3] >= 1.0e-12) && (params->variance_pose[3] <= 1000000.0)
          && (params->variance_pose[4] >= 1.0e-12) && (params->variance_pose[4] <= 1000000.0)
          && (params->variance_pose[5] >= 1.0e-12) && (params->variance_pose[5] <= 1000000.0)
          && (params->variance_pose[6] >= 1.0e-12) && (params->variance_pose[6] <= 1000000.0)
          && (params->variance_pose[7] >= 1.0e-12) && (params->variance_pose[7] <= 1000000.0)
          && (params->variance_pose[8] >= 1.0e-12) && (params->variance_pose[8] <= 1000000.0)
          && (params->variance_pose[9] >= 1.0e-12) && (params->variance_pose[9] <= 1000000.0)
          && (params->variance_pose[10] >= 1.0e-12) && (params->variance_pose[10] <= 1000000.0)
          && (params->variance_pose[11] >= 1.0e-12) && (params->variance_pose[11] <= 1000000.0)
          && (params->gate_pose >= 0.0) && (params->gate_pose <= 1000000.0) && (params->inflation >= 1.0)
          && (params->inflation <= 1000000.0) && (fabs(params->x_0) <= 10000.0) && (fabs(params->vx_0) <= 1000.0)
          && (fabs(params->y_0) <= 10000.0) && (fabs(params->vy_0) <= 1000.0) && (fabs(params->z_0) <= 10000.0)
          && (fabs(params->vz_0) <= 1000.0) && (fabs(params->roll_0) <= 30.0) && (fabs(params->roll_rate_0) <= 100.0)
          && (fabs(params->pitch_0) <= 30.0) && (fabs(params->pitch_rate_0) <= 100.0) && (fabs(params->yaw_0) <= 30.0)
          && (fabs(params->yaw_rate_0) <= 100.0) && (params->variance_x_0 >= 1.0e-12)
          && (params->variance_x_0 <= 1000000.0) && (params->variance_vx_0 >= 1.0e-12)
          && (params->variance_vx_0 <= 1000000.0) && (params->variance_y_0 >= 1.0e-12)
          && (params->variance_y_0 <= 1000000.0) && (params->variance_vy_0 >= 1.0e-12)
          && (params->variance_vy_0 <= 1000000.0) && (params->variance_z_0 >= 1.0e-12)
          && (params->variance_z_0 <= 1000000.0) && (params->variance_vz_0 >= 1.0e-12)
          && (params->variance_vz_0 <= 1000000.0) && (params->variance_roll_0 >= 1.0e-12)
          && (params->variance_roll_0 <= 1000000.0) && (params->variance_roll_rate_0 >= 1.0e-12)
          && (params->variance_roll_rate_0 <= 1000000.0) && (params->variance_pitch_0 >= 1.0e-12)
          && (params->variance_pitch_0 <= 1000000.0) && (params->variance_pitch_rate_0 >= 1.0e-12)
          && (params->variance_pitch_rate_0 <= 1000000.0) && (params->variance_yaw_0 >= 1.0e-12)
          && (params->variance_yaw_0 <= 1000000.0) && (params->variance_yaw_rate_0 >= 1.0e-12)
          && (params->variance_yaw_rate_0 <= 1000000.0)))
    {
        status = QUADROTOR_KF_BAD_PARAM;
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
        after->covariance[i] = 0.0;
        }
        after->covariance[0] = params->variance_x_0;
        after->covariance[12] = params->variance_vx_0;
        after->covariance[23] = params->variance_y_0;
        after->covariance[33] = params->variance_vy_0;
        after->covariance[42] = params->variance_z_0;
        after->covariance[50] = params->variance_vz_0;
        after->covariance[57] = params->variance_roll_0;
        after->covariance[63] = params->variance_roll_rate_0;
        after->covariance[68] = params->variance_pitch_0;
        after->covariance[72] = params->variance_pitch_rate_0;
        after->covariance[75] = params->variance_yaw_0;
        after->covariance[77] = params->variance_yaw_rate_0;
        after->rejected_pose = 0U;

        /* judge, then commit */
        if (!((after->covariance[0] >= 1.0e-20) && (after->covariance[0] <= 1.0e9) && (after->covariance[12] >= 1.0e-20)
              && (after->covariance[12] <= 1.0e9) && (after->covariance[23] >= 1.0e-20)
              && (after->covariance[23] <= 1.0e9) && (after->covariance[33] >= 1.0e-20)
              && (after->covariance[33] <= 1.0e9) && (after->covariance[42] >= 1.0e-20)
              && (after->covariance[42] <= 1.0e9) && (after->covariance[50] >= 1.0e-20)
              && (after->covariance[50] <= 1.0e9) && (after->covariance[57] >= 1.0e-20)
              && (after->covariance[57] <= 1.0e9) && (after->covariance[63] >= 1.0e-20)
              && (after->covariance[63] <= 1.0e9) && (after->covariance[68] >= 1.0e-20)
              && (after->covariance[68] <= 1.0e9) && (after->covariance[72] >= 1.0e-20)
              && (after->covariance[72] <= 1.0e9) && (after->covariance[75] >= 1.0e-20)
              && (after->covariance[75] <= 1.0e9) && (after->covariance[77] >= 1.0e-20)
              && (after->covariance[77] <= 1.0e9)))
        {
            status = quadrotor_kf_hold_variances(after->covariance);
        }
    }
    return status;
}

/* 146 additions, 117 multiplications, 1 negation. */
static quadrotor_kf_status_t quadrotor_kf_predict_core(const quadrotor_kf_state_t *before, quadrotor_kf_state_t *after,
                                                       const quadrotor_kf_params_t *params, const double rotor_1,
                                                       const double rotor_2, const double rotor_3,
                                                       const double rotor_4)
{
    quadrotor_kf_status_t status = QUADROTOR_KF_OK;

    after->rejected_pose = before->rejected_pose;

    if (!((fabs(rotor_1) <= 1000.0) && (fabs(rotor_2) <= 1000.0) && (fabs(rotor_3) <= 1000.0)
          && (fabs(rotor_4) <= 1000.0)))
    {
        status = QUADROTOR_KF_BAD_INPUT;
    }
    else
    {
        /* x = f(x, u) */
        /* x+ = x + 0.025 vx */
        /* vx+ = vx + 0.24525 pitch */
        /* y+ = y + 0.025 vy */
        /* vy+ = vy + -0.24525 roll */
        /* z+ = 30 + z - 30 + 0.025 vz */
        /* vz+ = vz + 0.000576466607879 (rotor_1 - 212.718305491) + 0.000576466607879 (rotor_2 - 212.718305491) +
         * 0.000576466607879 (rotor_3 - 212.718305491) + 0.000576466607879 (rotor_4 - 212.718305491) */
        /* roll+ = roll + 0.025 roll_rate */
        /* roll_rate+ = roll_rate + -0.0170804920853 (rotor_1 - 212.718305491) + -0.0170804920853 (rotor_2 -
         * 212.718305491) + 0.0170804920853 (rotor_3 - 212.718305491) + 0.0170804920853 (rotor_4 - 212.718305491) */
        /* pitch+ = pitch + 0.025 pitch_rate */
        /* pitch_rate+ = pitch_rate + -0.0170804920853 (rotor_1 - 212.718305491) + 0.0170804920853 (rotor_2 -
         * 212.718305491) + 0.0170804920853 (rotor_3 - 212.718305491) + -0.0170804920853 (rotor_4 - 212.718305491) */
        /* yaw+ = yaw + 0.025 yaw_rate */
        /* yaw_rate+ = yaw_rate + 0.000823908929717 (rotor_1 - 212.718305491) + -0.000823908929717 (rotor_2 -
         * 212.718305491) + 0.000823908929717 (rotor_3 - 212.718305491) + -0.000823908929717 (rotor_4 -
         * 212.718305491) */
        const double vx = before->vx;
        after->x = before->x + (vx * 0.025);
        const double pitch = before->pitch;
        after->vx = vx + (pitch * 0.24525);
        const double vy = before->vy;
        after->y = before->y + (vy * 0.025);
        const double roll = before->roll;
        after->vy = vy - (roll * 0.24525);
        const double vz = before->vz;
        after->z = 30.0 + ((before->z - 30.0) + (vz * 0.025));
        const double v = rotor_1 - 212.718305491;
        const double v_2 = rotor_2 - 212.718305491;
        const double v_3 = rotor_3 - 212.718305491;
        const double v_4 = rotor_4 - 212.718305491;
        const double v_5 = (((0.000576466607879 * v) + (0.000576466607879 * v_2)) + (0.000576466607879 * v_3)) +
            (0.000576466607879 * v_4);
        after->vz = vz + v_5;
        const double roll_rate = before->roll_rate;
        after->roll = roll + (roll_rate * 0.025);
        const double v_6 = v * 0.0170804920853;
        const double v_7 = v_2 * 0.0170804920853;
        const double v_8 = v_3 * 0.0170804920853;
        const double v_9 = v_4 * 0.0170804920853;
        after->roll_rate = roll_rate + ((((-v_6) - v_7) + v_8) + v_9);
        const double pitch_rate = before->pitch_rate;
        after->pitch = pitch + (pitch_rate * 0.025);
        after->pitch_rate = pitch_rate + ((v_8 + (v_7 - v_6)) - v_9);
        const double yaw_rate = before->yaw_rate;
        after->yaw = before->yaw + (yaw_rate * 0.025);
        const double v_10 = (((v * 0.000823908929717) - (v_2 * 0.000823908929717)) + (v_3 * 0.000823908929717)) - (v_4 *
            0.000823908929717);
        after->yaw_rate = yaw_rate + v_10;

        /* P = F P F' + Q */
        {
            const double p_0_1 = before->covariance[1];
            const double p_1_1 = before->covariance[12];
            const double v_11 = p_0_1 + (0.025 * p_1_1);
            after->covariance[0] = params->variance_step_x + ((before->covariance[0] + (0.025 * p_0_1)) + (0.025 *
                v_11));
            const double p_1_8 = before->covariance[19];
            const double v_12 = before->covariance[8] + (0.025 * p_1_8);
            after->covariance[1] = v_11 + (0.24525 * v_12);
            const double p_1_2 = before->covariance[13];
            const double p_1_3 = before->covariance[14];
            const double v_13 = before->covariance[3] + (0.025 * p_1_3);
            after->covariance[2] = (before->covariance[2] + (0.025 * p_1_2)) + (0.025 * v_13);
            const double p_1_6 = before->covariance[17];
            const double v_14 = before->covariance[6] + (0.025 * p_1_6);
            after->covariance[3] = v_13 - (0.24525 * v_14);
            const double p_1_4 = before->covariance[15];
            const double p_1_5 = before->covariance[16];
            const double v_15 = before->covariance[5] + (0.025 * p_1_5);
            after->covariance[4] = (before->covariance[4] + (0.025 * p_1_4)) + (0.025 * v_15);
            after->covariance[5] = v_15;
            const double p_1_7 = before->covariance[18];
            const double v_16 = before->covariance[7] + (0.025 * p_1_7);
            after->covariance[6] = v_14 + (0.025 * v_16);
            after->covariance[7] = v_16;
            const double p_1_9 = before->covariance[20];
            const double v_17 = before->covariance[9] + (0.025 * p_1_9);
            after->covariance[8] = v_12 + (0.025 * v_17);
            after->covariance[9] = v_17;
            const double p_1_10 = before->covariance[21];
            const double p_1_11 = before->covariance[22];
            const double v_18 = before->covariance[11] + (0.025 * p_1_11);
            after->covariance[10] = (before->covariance[10] + (0.025 * p_1_10)) + (0.025 * v_18);
            after->covariance[11] = v_18;
            const double p_8_8 = before->covariance[68];
            const double v_19 = p_1_8 + (0.24525 * p_8_8);
            after->covariance[12] = params->variance_step_vx + ((p_1_1 + (0.24525 * p_1_8)) + (0.24525 * v_19));
            const double p_2_8 = before->covariance[29];
            const double p_3_8 = before->covariance[38];
            const double v_20 = p_1_3 + (0.24525 * p_3_8);
            after->covariance[13] = (p_1_2 + (0.24525 * p_2_8)) + (0.025 * v_20);
            const double p_6_8 = before->covariance[59];
            const double v_21 = 0.24525 * p_6_8;
            const double v_22 = p_1_6 + v_21;
            after->covariance[14] = v_20 - (0.24525 * v_22);
            const double p_4_8 = before->covariance[46];
            const double p_5_8 = before->covariance[53];
            const double v_23 = p_1_5 + (0.24525 * p_5_8);
            after->covariance[15] = (p_1_4 + (0.24525 * p_4_8)) + (0.025 * v_23);
            after->covariance[16] = v_23;
            const double p_7_8 = before->covariance[64];
            const double v_24 = p_1_7 + (0.24525 * p_7_8);
            after->covariance[17] = v_22 + (0.025 * v_24);
            after->covariance[18] = v_24;
            const double p_8_9 = before->covariance[69];
            const double v_25 = p_1_9 + (0.24525 * p_8_9);
            after->covariance[19] = v_19 + (0.025 * v_25);
            after->covariance[20] = v_25;
            const double p_8_10 = before->covariance[70];
            const double p_8_11 = before->covariance[71];
            const double v_26 = p_1_11 + (0.24525 * p_8_11);
            after->covariance[21] = (p_1_10 + (0.24525 * p_8_10)) + (0.025 * v_26);
            after->covariance[22] = v_26;
            const double p_2_3 = before->covariance[24];
            const double p_3_3 = before->covariance[33];
            const double v_27 = p_2_3 + (0.025 * p_3_3);
            after->covariance[23] = params->variance_step_y + ((before->covariance[23] + (0.025 * p_2_3)) + (0.025 *
                v_27));
            const double p_3_6 = before->covariance[36];
            const double v_28 = before->covariance[27] + (0.025 * p_3_6);
            after->covariance[24] = v_27 - (0.24525 * v_28);
            const double p_3_4 = before->covariance[34];
            const double p_3_5 = before->covariance[35];
            const double v_29 = before->covariance[26] + (0.025 * p_3_5);
            after->covariance[25] = (before->covariance[25] + (0.025 * p_3_4)) + (0.025 * v_29);
            after->covariance[26] = v_29;
            const double p_3_7 = before->covariance[37];
            const double v_30 = before->covariance[28] + (0.025 * p_3_7);
            after->covariance[27] = v_28 + (0.025 * v_30);
            after->covariance[28] = v_30;
            const double p_3_9 = before->covariance[39];
            const double v_31 = before->covariance[30] + (0.025 * p_3_9);
            after->covariance[29] = (p_2_8 + (0.025 * p_3_8)) + (0.025 * v_31);
            after->covariance[30] = v_31;
            const double p_3_10 = before->covariance[40];
            const double p_3_11 = before->covariance[41];
            const double v_32 = before->covariance[32] + (0.025 * p_3_11);
            after->covariance[31] = (before->covariance[31] + (0.025 * p_3_10)) + (0.025 * v_32);
            after->covariance[32] = v_32;
            const double p_6_6 = before->covariance[57];
            const double v_33 = p_3_6 - (0.24525 * p_6_6);
            after->covariance[33] = params->variance_step_vy + ((p_3_3 - (0.24525 * p_3_6)) - (0.24525 * v_33));
            const double p_4_6 = before->covariance[44];
            const double p_5_6 = before->covariance[51];
            const double v_34 = p_3_5 - (0.24525 * p_5_6);
            after->covariance[34] = (p_3_4 - (0.24525 * p_4_6)) + (0.025 * v_34);
            after->covariance[35] = v_34;
            const double p_6_7 = before->covariance[58];
            const double v_35 = p_3_7 - (0.24525 * p_6_7);
            after->covariance[36] = v_33 + (0.025 * v_35);
            after->covariance[37] = v_35;
            const double p_6_9 = before->covariance[60];
            const double v_36 = p_3_9 - (0.24525 * p_6_9);
            after->covariance[38] = (p_3_8 - v_21) + (0.025 * v_36);
            after->covariance[39] = v_36;
            const double p_6_10 = before->covariance[61];
            const double p_6_11 = before->covariance[62];
            const double v_37 = p_3_11 - (0.24525 * p_6_11);
            after->covariance[40] = (p_3_10 - (0.24525 * p_6_10)) + (0.025 * v_37);
            after->covariance[41] = v_37;
            const double p_4_5 = before->covariance[43];
            const double p_5_5 = before->covariance[50];
            const double v_38 = p_4_5 + (0.025 * p_5_5);
            after->covariance[42] = params->variance_step_z + ((before->covariance[42] + (0.025 * p_4_5)) + (0.025 *
                v_38));
            after->covariance[43] = v_38;
            const double p_5_7 = before->covariance[52];
            const double v_39 = 0.025 * p_5_7;
            const double v_40 = before->covariance[45] + v_39;
            after->covariance[44] = (p_4_6 + (0.025 * p_5_6)) + (0.025 * v_40);
            after->covariance[45] = v_40;
            const double p_5_9 = before->covariance[54];
            const double v_41 = 0.025 * p_5_9;
            const double v_42 = before->covariance[47] + v_41;
            after->covariance[46] = (p_4_8 + (0.025 * p_5_8)) + (0.025 * v_42);
            after->covariance[47] = v_42;
            const double p_5_10 = before->covariance[55];
            const double p_5_11 = before->covariance[56];
            const double v_43 = 0.025 * p_5_11;
            const double v_44 = before->covariance[49] + v_43;
            after->covariance[48] = (before->covariance[48] + (0.025 * p_5_10)) + (0.025 * v_44);
            after->covariance[49] = v_44;
            after->covariance[50] = params->variance_step_vz + p_5_5;
            after->covariance[51] = p_5_6 + v_39;
            after->covariance[52] = p_5_7;
            after->covariance[53] = p_5_8 + v_41;
            after->covariance[54] = p_5_9;
            after->covariance[55] = p_5_10 + v_43;
            after->covariance[56] = p_5_11;
            const double p_7_7 = before->covariance[63];
            const double v_45 = p_6_7 + (0.025 * p_7_7);
            after->covariance[57] = params->variance_step_roll + ((p_6_6 + (0.025 * p_6_7)) + (0.025 * v_45));
            after->covariance[58] = v_45;
            const double p_7_9 = before->covariance[65];
            const double v_46 = 0.025 * p_7_9;
            const double v_47 = p_6_9 + v_46;
            after->covariance[59] = (p_6_8 + (0.025 * p_7_8)) + (0.025 * v_47);
            after->covariance[60] = v_47;
            const double p_7_10 = before->covariance[66];
            const double p_7_11 = before->covariance[67];
            const double v_48 = 0.025 * p_7_11;
            const double v_49 = p_6_11 + v_48;
            after->covariance[61] = (p_6_10 + (0.025 * p_7_10)) + (0.025 * v_49);
            after->covariance[62] = v_49;
            after->covariance[63] = params->variance_step_roll_rate + p_7_7;
            after->covariance[64] = p_7_8 + v_46;
            after->covariance[65] = p_7_9;
            after->covariance[66] = p_7_10 + v_48;
            after->covariance[67] = p_7_11;
            const double p_9_9 = before->covariance[72];
            const double v_50 = p_8_9 + (0.025 * p_9_9);
            after->covariance[68] = params->variance_step_pitch + ((p_8_8 + (0.025 * p_8_9)) + (0.025 * v_50));
            after->covariance[69] = v_50;
            const double p_9_10 = before->covariance[73];
            const double p_9_11 = before->covariance[74];
            const double v_51 = 0.025 * p_9_11;
            const double v_52 = p_8_11 + v_51;
            after->covariance[70] = (p_8_10 + (0.025 * p_9_10)) + (0.025 * v_52);
            after->covariance[71] = v_52;
            after->covariance[72] = params->variance_step_pitch_rate + p_9_9;
            after->covariance[73] = p_9_10 + v_51;
            after->covariance[74] = p_9_11;
            const double p_10_11 = before->covariance[76];
            const double p_11_11 = before->covariance[77];
            const double v_53 = p_10_11 + (0.025 * p_11_11);
            after->covariance[75] = params->variance_step_yaw + ((before->covariance[75] + (0.025 * p_10_11)) + (0.025 *
                v_53));
            after->covariance[76] = v_53;
            after->covariance[77] = params->variance_step_yaw_rate + p_11_11;
        }

        /* judge, then commit */
        if (!((after->covariance[0] >= 1.0e-20) && (after->covariance[0] <= 1.0e9) && (after->covariance[12] >= 1.0e-20)
              && (after->covariance[12] <= 1.0e9) && (after->covariance[23] >= 1.0e-20)
              && (after->covariance[23] <= 1.0e9) && (after->covariance[33] >= 1.0e-20)
              && (after->covariance[33] <= 1.0e9) && (after->covariance[42] >= 1.0e-20)
              && (after->covariance[42] <= 1.0e9) && (after->covariance[50] >= 1.0e-20)
              && (after->covariance[50] <= 1.0e9) && (after->covariance[57] >= 1.0e-20)
              && (after->covariance[57] <= 1.0e9) && (after->covariance[63] >= 1.0e-20)
              && (after->covariance[63] <= 1.0e9) && (after->covariance[68] >= 1.0e-20)
              && (after->covariance[68] <= 1.0e9) && (after->covariance[72] >= 1.0e-20)
              && (after->covariance[72] <= 1.0e9) && (after->covariance[75] >= 1.0e-20)
              && (after->covariance[75] <= 1.0e9) && (after->covariance[77] >= 1.0e-20)
              && (after->covariance[77] <= 1.0e9)))
        {
            status = quadrotor_kf_hold_variances(after->covariance);
        }
        if (status >= QUADROTOR_KF_OK)
        {
            if (!((fabs(after->x) <= 10000.0) && (fabs(after->vx) <= 1000.0) && (fabs(after->y) <= 10000.0)
                  && (fabs(after->vy) <= 1000.0) && (fabs(after->z) <= 10000.0) && (fabs(after->vz) <= 1000.0)
                  && (fabs(after->roll) <= 30.0) && (fabs(after->roll_rate) <= 100.0) && (fabs(after->pitch) <= 30.0)
                  && (fabs(after->pitch_rate) <= 100.0) && (fabs(after->yaw) <= 30.0)
                  && (fabs(after->yaw_rate) <= 100.0) && (fabs(after->covariance[1]) <= 1.0e9)
                  && (fabs(after->covariance[2]) <= 1.0e9) && (fabs(after->covariance[3]) <= 1.0e9)
                  && (fabs(after->covariance[4]) <= 1.0e9) && (fabs(after->covariance[5]) <= 1.0e9)
                  && (fabs(after->covariance[6]) <= 1.0e9) && (fabs(after->covariance[7]) <= 1.0e9)
                  && (fabs(after->covariance[8]) <= 1.0e9) && (fabs(after->covariance[9]) <= 1.0e9)
                  && (fabs(after->covariance[10]) <= 1.0e9) && (fabs(after->covariance[11]) <= 1.0e9)
                  && (fabs(after->covariance[13]) <= 1.0e9) && (fabs(after->covariance[14]) <= 1.0e9)
                  && (fabs(after->covariance[15]) <= 1.0e9) && (fabs(after->covariance[16]) <= 1.0e9)
                  && (fabs(after->covariance[17]) <= 1.0e9) && (fabs(after->covariance[18]) <= 1.0e9)
                  && (fabs(after->covariance[19]) <= 1.0e9) && (fabs(after->covariance[20]) <= 1.0e9)
                  && (fabs(after->covariance[21]) <= 1.0e9) && (fabs(after->covariance[22]) <= 1.0e9)
                  && (fabs(after->covariance[24]) <= 1.0e9) && (fabs(after->covariance[25]) <= 1.0e9)
                  && (fabs(after->covariance[26]) <= 1.0e9) && (fabs(after->covariance[27]) <= 1.0e9)
                  && (fabs(after->covariance[28]) <= 1.0e9) && (fabs(after->covariance[29]) <= 1.0e9)
                  && (fabs(after->covariance[30]) <= 1.0e9) && (fabs(after->covariance[31]) <= 1.0e9)
                  && (fabs(after->covariance[32]) <= 1.0e9) && (fabs(after->covariance[34]) <= 1.0e9)
                  && (fabs(after->covariance[35]) <= 1.0e9) && (fabs(after->covariance[36]) <= 1.0e9)
                  && (fabs(after->covariance[37]) <= 1.0e9) && (fabs(after->covariance[38]) <= 1.0e9)
                  && (fabs(after->covariance[39]) <= 1.0e9) && (fabs(after->covariance[40]) <= 1.0e9)
                  && (fabs(after->covariance[41]) <= 1.0e9) && (fabs(after->covariance[43]) <= 1.0e9)
                  && (fabs(after->covariance[44]) <= 1.0e9) && (fabs(after->covariance[45]) <= 1.0e9)
                  && (fabs(after->covariance[46]) <= 1.0e9) && (fabs(after->covariance[47]) <= 1.0e9)
                  && (fabs(after->covariance[48]) <= 1.0e9) && (fabs(after->covariance[49]) <= 1.0e9)
                  && (fabs(after->covariance[51]) <= 1.0e9) && (fabs(after->covariance[52]) <= 1.0e9)
                  && (fabs(after->covariance[53]) <= 1.0e9) && (fabs(after->covariance[54]) <= 1.0e9)
                  && (fabs(after->covariance[55]) <= 1.0e9) && (fabs(after->covariance[56]) <= 1.0e9)
                  && (fabs(after->covariance[58]) <= 1.0e9) && (fabs(after->covariance[59]) <= 1.0e9)
                  && (fabs(after->covariance[60]) <= 1.0e9) && (fabs(after->covariance[61]) <= 1.0e9)
                  && (fabs(after->covariance[62]) <= 1.0e9) && (fabs(after->covariance[64]) <= 1.0e9)
                  && (fabs(after->covariance[65]) <= 1.0e9) && (fabs(after->covariance[66]) <= 1.0e9)
                  && (fabs(after->covariance[67]) <= 1.0e9) && (fabs(after->covariance[69]) <= 1.0e9)
                  && (fabs(after->covariance[70]) <= 1.0e9) && (fabs(after->covariance[71]) <= 1.0e9)
                  && (fabs(after->covariance[73]) <= 1.0e9) && (fabs(after->covariance[74]) <= 1.0e9)
                  && (fabs(after->covariance[76]) <= 1.0e9)))
            {
                status = QUADROTOR_KF_OVERFLOW;
            }
        }
    }
    return status;
}

/* 994 additions, 1248 multiplications, 12 divisions, 36 negations, 12 selections. */
static quadrotor_kf_status_t quadrotor_kf_update_pose_core(const quadrotor_kf_state_t *before,
                                                           quadrotor_kf_state_t *after,
                                                           const quadrotor_kf_params_t *params, const double pose[12],
                                                           const double gate, quadrotor_kf_update_pose_out_t *out)
{
    double delta[12];
    double nis[1];
    double row_variance[12];
    quadrotor_kf_status_t status = QUADROTOR_KF_OK;

    if (!((fabs(pose[0]) <= 1000000.0) && (fabs(pose[1]) <= 1000000.0) && (fabs(pose[2]) <= 1000000.0)
          && (fabs(pose[3]) <= 1000000.0) && (fabs(pose[4]) <= 1000000.0) && (fabs(pose[5]) <= 1000000.0)
          && (fabs(pose[6]) <= 1000000.0) && (fabs(pose[7]) <= 1000000.0) && (fabs(pose[8]) <= 1000000.0)
          && (fabs(pose[9]) <= 1000000.0) && (fabs(pose[10]) <= 1000000.0) && (fabs(pose[11]) <= 1000000.0)))
    {
        status = QUADROTOR_KF_BAD_INPUT;
    }
    else
    {
        /* residual[0] = pose[0] - (x) */
        /* residual[1] = pose[1] - (vx) */
        /* residual[2] = pose[2] - (y) */
        /* residual[3] = pose[3] - (vy) */
        /* residual[4] = pose[4] - (z) */
        /* residual[5] = pose[5] - (vz) */
        /* residual[6] = pose[6] - (roll) */
        /* residual[7] = pose[7] - (roll_rate) */
        /* residual[8] = pose[8] - (pitch) */
        /* residual[9] = pose[9] - (pitch_rate) */
        /* residual[10] = pose[10] - (yaw) */
        /* residual[11] = pose[11] - (yaw_rate) */
        const double residual_0 = pose[0] - before->x;
        const double residual_1 = pose[1] - before->vx;
        const double residual_2 = pose[2] - before->y;
        const double residual_3 = pose[3] - before->vy;
        const double residual_4 = pose[4] - before->z;
        const double residual_5 = pose[5] - before->vz;
        const double residual_6 = pose[6] - before->roll;
        const double residual_7 = pose[7] - before->roll_rate;
        const double residual_8 = pose[8] - before->pitch;
        const double residual_9 = pose[9] - before->pitch_rate;
        const double residual_10 = pose[10] - before->yaw;
        const double residual_11 = pose[11] - before->yaw_rate;

        /* variance of the innovation: diagonal of H P H' + R */
        {
            out->variance[0] = params->variance_pose[0] + before->covariance[0];
            out->variance[1] = params->variance_pose[1] + before->covariance[12];
            out->variance[2] = params->variance_pose[2] + before->covariance[23];
            out->variance[3] = params->variance_pose[3] + before->covariance[33];
            out->variance[4] = params->variance_pose[4] + before->covariance[42];
            out->variance[5] = params->variance_pose[5] + before->covariance[50];
            out->variance[6] = params->variance_pose[6] + before->covariance[57];
            out->variance[7] = params->variance_pose[7] + before->covariance[63];
            out->variance[8] = params->variance_pose[8] + before->covariance[68];
            out->variance[9] = params->variance_pose[9] + before->covariance[72];
            out->variance[10] = params->variance_pose[10] + before->covariance[75];
            out->variance[11] = params->variance_pose[11] + before->covariance[77];
        }
        out->innovation[0] = residual_0;
        out->innovation[1] = residual_1;
        out->innovation[2] = residual_2;
        out->innovation[3] = residual_3;
        out->innovation[4] = residual_4;
        out->innovation[5] = residual_5;
        out->innovation[6] = residual_6;
        out->innovation[7] = residual_7;
        out->innovation[8] = residual_8;
        out->innovation[9] = residual_9;
        out->innovation[10] = residual_10;
        out->innovation[11] = residual_11;

        /* row 0: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_0 = before->covariance[0];
            const double r_0 = params->variance_pose[0];
            const double s = r_0 + p_0_0;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_0 * minus_per_s;
            const double minus_r = -r_0;
            after->covariance[0] = n_0 * minus_r;
            const double p_0_1 = before->covariance[1];
            const double n_1 = p_0_1 * minus_per_s;
            after->covariance[1] = n_1 * minus_r;
            const double p_0_2 = before->covariance[2];
            const double n_2 = p_0_2 * minus_per_s;
            after->covariance[2] = n_2 * minus_r;
            const double p_0_3 = before->covariance[3];
            const double n_3 = p_0_3 * minus_per_s;
            after->covariance[3] = n_3 * minus_r;
            const double p_0_4 = before->covariance[4];
            const double n_4 = p_0_4 * minus_per_s;
            after->covariance[4] = n_4 * minus_r;
            const double p_0_5 = before->covariance[5];
            const double n_5 = p_0_5 * minus_per_s;
            after->covariance[5] = n_5 * minus_r;
            const double p_0_6 = before->covariance[6];
            const double n_6 = p_0_6 * minus_per_s;
            after->covariance[6] = n_6 * minus_r;
            const double p_0_7 = before->covariance[7];
            const double n_7 = p_0_7 * minus_per_s;
            after->covariance[7] = n_7 * minus_r;
            const double p_0_8 = before->covariance[8];
            const double n_8 = p_0_8 * minus_per_s;
            after->covariance[8] = n_8 * minus_r;
            const double p_0_9 = before->covariance[9];
            const double n_9 = p_0_9 * minus_per_s;
            after->covariance[9] = n_9 * minus_r;
            const double p_0_10 = before->covariance[10];
            const double n_10 = p_0_10 * minus_per_s;
            after->covariance[10] = n_10 * minus_r;
            const double p_0_11 = before->covariance[11];
            const double n_11 = p_0_11 * minus_per_s;
            after->covariance[11] = n_11 * minus_r;
            after->covariance[12] = before->covariance[12] + (p_0_1 * n_1);
            after->covariance[13] = before->covariance[13] + (p_0_2 * n_1);
            after->covariance[14] = before->covariance[14] + (p_0_3 * n_1);
            after->covariance[15] = before->covariance[15] + (p_0_4 * n_1);
            after->covariance[16] = before->covariance[16] + (p_0_5 * n_1);
            after->covariance[17] = before->covariance[17] + (p_0_6 * n_1);
            after->covariance[18] = before->covariance[18] + (p_0_7 * n_1);
            after->covariance[19] = before->covariance[19] + (p_0_8 * n_1);
            after->covariance[20] = before->covariance[20] + (p_0_9 * n_1);
            after->covariance[21] = before->covariance[21] + (p_0_10 * n_1);
            after->covariance[22] = before->covariance[22] + (p_0_11 * n_1);
            after->covariance[23] = before->covariance[23] + (p_0_2 * n_2);
            after->covariance[24] = before->covariance[24] + (p_0_3 * n_2);
            after->covariance[25] = before->covariance[25] + (p_0_4 * n_2);
            after->covariance[26] = before->covariance[26] + (p_0_5 * n_2);
            after->covariance[27] = before->covariance[27] + (p_0_6 * n_2);
            after->covariance[28] = before->covariance[28] + (p_0_7 * n_2);
            after->covariance[29] = before->covariance[29] + (p_0_8 * n_2);
            after->covariance[30] = before->covariance[30] + (p_0_9 * n_2);
            after->covariance[31] = before->covariance[31] + (p_0_10 * n_2);
            after->covariance[32] = before->covariance[32] + (p_0_11 * n_2);
            after->covariance[33] = before->covariance[33] + (p_0_3 * n_3);
            after->covariance[34] = before->covariance[34] + (p_0_4 * n_3);
            after->covariance[35] = before->covariance[35] + (p_0_5 * n_3);
            after->covariance[36] = before->covariance[36] + (p_0_6 * n_3);
            after->covariance[37] = before->covariance[37] + (p_0_7 * n_3);
            after->covariance[38] = before->covariance[38] + (p_0_8 * n_3);
            after->covariance[39] = before->covariance[39] + (p_0_9 * n_3);
            after->covariance[40] = before->covariance[40] + (p_0_10 * n_3);
            after->covariance[41] = before->covariance[41] + (p_0_11 * n_3);
            after->covariance[42] = before->covariance[42] + (p_0_4 * n_4);
            after->covariance[43] = before->covariance[43] + (p_0_5 * n_4);
            after->covariance[44] = before->covariance[44] + (p_0_6 * n_4);
            after->covariance[45] = before->covariance[45] + (p_0_7 * n_4);
            after->covariance[46] = before->covariance[46] + (p_0_8 * n_4);
            after->covariance[47] = before->covariance[47] + (p_0_9 * n_4);
            after->covariance[48] = before->covariance[48] + (p_0_10 * n_4);
            after->covariance[49] = before->covariance[49] + (p_0_11 * n_4);
            after->covariance[50] = before->covariance[50] + (p_0_5 * n_5);
            after->covariance[51] = before->covariance[51] + (p_0_6 * n_5);
            after->covariance[52] = before->covariance[52] + (p_0_7 * n_5);
            after->covariance[53] = before->covariance[53] + (p_0_8 * n_5);
            after->covariance[54] = before->covariance[54] + (p_0_9 * n_5);
            after->covariance[55] = before->covariance[55] + (p_0_10 * n_5);
            after->covariance[56] = before->covariance[56] + (p_0_11 * n_5);
            after->covariance[57] = before->covariance[57] + (p_0_6 * n_6);
            after->covariance[58] = before->covariance[58] + (p_0_7 * n_6);
            after->covariance[59] = before->covariance[59] + (p_0_8 * n_6);
            after->covariance[60] = before->covariance[60] + (p_0_9 * n_6);
            after->covariance[61] = before->covariance[61] + (p_0_10 * n_6);
            after->covariance[62] = before->covariance[62] + (p_0_11 * n_6);
            after->covariance[63] = before->covariance[63] + (p_0_7 * n_7);
            after->covariance[64] = before->covariance[64] + (p_0_8 * n_7);
            after->covariance[65] = before->covariance[65] + (p_0_9 * n_7);
            after->covariance[66] = before->covariance[66] + (p_0_10 * n_7);
            after->covariance[67] = before->covariance[67] + (p_0_11 * n_7);
            after->covariance[68] = before->covariance[68] + (p_0_8 * n_8);
            after->covariance[69] = before->covariance[69] + (p_0_9 * n_8);
            after->covariance[70] = before->covariance[70] + (p_0_10 * n_8);
            after->covariance[71] = before->covariance[71] + (p_0_11 * n_8);
            after->covariance[72] = before->covariance[72] + (p_0_9 * n_9);
            after->covariance[73] = before->covariance[73] + (p_0_10 * n_9);
            after->covariance[74] = before->covariance[74] + (p_0_11 * n_9);
            after->covariance[75] = before->covariance[75] + (p_0_10 * n_10);
            after->covariance[76] = before->covariance[76] + (p_0_11 * n_10);
            after->covariance[77] = before->covariance[77] + (p_0_11 * n_11);
            const double minus_e = -residual_0;
            delta[0] = n_0 * minus_e;
            delta[1] = n_1 * minus_e;
            delta[2] = n_2 * minus_e;
            delta[3] = n_3 * minus_e;
            delta[4] = n_4 * minus_e;
            delta[5] = n_5 * minus_e;
            delta[6] = n_6 * minus_e;
            delta[7] = n_7 * minus_e;
            delta[8] = n_8 * minus_e;
            delta[9] = n_9 * minus_e;
            delta[10] = n_10 * minus_e;
            delta[11] = n_11 * minus_e;
            nis[0] = residual_0 * (residual_0 * per_s);
            row_variance[0] = s;
        }

        /* row 1: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_1 = after->covariance[1];
            const double r_1 = params->variance_pose[1];
            const double p_1_1 = after->covariance[12];
            const double s = r_1 + p_1_1;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_1 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_1 * n_0);
            const double minus_r = -r_1;
            after->covariance[1] = n_0 * minus_r;
            const double p_1_2 = after->covariance[13];
            after->covariance[2] = after->covariance[2] + (p_1_2 * n_0);
            const double p_1_3 = after->covariance[14];
            after->covariance[3] = after->covariance[3] + (p_1_3 * n_0);
            const double p_1_4 = after->covariance[15];
            after->covariance[4] = after->covariance[4] + (p_1_4 * n_0);
            const double p_1_5 = after->covariance[16];
            after->covariance[5] = after->covariance[5] + (p_1_5 * n_0);
            const double p_1_6 = after->covariance[17];
            after->covariance[6] = after->covariance[6] + (p_1_6 * n_0);
            const double p_1_7 = after->covariance[18];
            after->covariance[7] = after->covariance[7] + (p_1_7 * n_0);
            const double p_1_8 = after->covariance[19];
            after->covariance[8] = after->covariance[8] + (p_1_8 * n_0);
            const double p_1_9 = after->covariance[20];
            after->covariance[9] = after->covariance[9] + (p_1_9 * n_0);
            const double p_1_10 = after->covariance[21];
            after->covariance[10] = after->covariance[10] + (p_1_10 * n_0);
            const double p_1_11 = after->covariance[22];
            after->covariance[11] = after->covariance[11] + (p_1_11 * n_0);
            const double n_1 = p_1_1 * minus_per_s;
            after->covariance[12] = n_1 * minus_r;
            const double n_2 = p_1_2 * minus_per_s;
            after->covariance[13] = n_2 * minus_r;
            const double n_3 = p_1_3 * minus_per_s;
            after->covariance[14] = n_3 * minus_r;
            const double n_4 = p_1_4 * minus_per_s;
            after->covariance[15] = n_4 * minus_r;
            const double n_5 = p_1_5 * minus_per_s;
            after->covariance[16] = n_5 * minus_r;
            const double n_6 = p_1_6 * minus_per_s;
            after->covariance[17] = n_6 * minus_r;
            const double n_7 = p_1_7 * minus_per_s;
            after->covariance[18] = n_7 * minus_r;
            const double n_8 = p_1_8 * minus_per_s;
            after->covariance[19] = n_8 * minus_r;
            const double n_9 = p_1_9 * minus_per_s;
            after->covariance[20] = n_9 * minus_r;
            const double n_10 = p_1_10 * minus_per_s;
            after->covariance[21] = n_10 * minus_r;
            const double n_11 = p_1_11 * minus_per_s;
            after->covariance[22] = n_11 * minus_r;
            after->covariance[23] = after->covariance[23] + (p_1_2 * n_2);
            after->covariance[24] = after->covariance[24] + (p_1_3 * n_2);
            after->covariance[25] = after->covariance[25] + (p_1_4 * n_2);
            after->covariance[26] = after->covariance[26] + (p_1_5 * n_2);
            after->covariance[27] = after->covariance[27] + (p_1_6 * n_2);
            after->covariance[28] = after->covariance[28] + (p_1_7 * n_2);
            after->covariance[29] = after->covariance[29] + (p_1_8 * n_2);
            after->covariance[30] = after->covariance[30] + (p_1_9 * n_2);
            after->covariance[31] = after->covariance[31] + (p_1_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_1_11 * n_2);
            after->covariance[33] = after->covariance[33] + (p_1_3 * n_3);
            after->covariance[34] = after->covariance[34] + (p_1_4 * n_3);
            after->covariance[35] = after->covariance[35] + (p_1_5 * n_3);
            after->covariance[36] = after->covariance[36] + (p_1_6 * n_3);
            after->covariance[37] = after->covariance[37] + (p_1_7 * n_3);
            after->covariance[38] = after->covariance[38] + (p_1_8 * n_3);
            after->covariance[39] = after->covariance[39] + (p_1_9 * n_3);
            after->covariance[40] = after->covariance[40] + (p_1_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_1_11 * n_3);
            after->covariance[42] = after->covariance[42] + (p_1_4 * n_4);
            after->covariance[43] = after->covariance[43] + (p_1_5 * n_4);
            after->covariance[44] = after->covariance[44] + (p_1_6 * n_4);
            after->covariance[45] = after->covariance[45] + (p_1_7 * n_4);
            after->covariance[46] = after->covariance[46] + (p_1_8 * n_4);
            after->covariance[47] = after->covariance[47] + (p_1_9 * n_4);
            after->covariance[48] = after->covariance[48] + (p_1_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_1_11 * n_4);
            after->covariance[50] = after->covariance[50] + (p_1_5 * n_5);
            after->covariance[51] = after->covariance[51] + (p_1_6 * n_5);
            after->covariance[52] = after->covariance[52] + (p_1_7 * n_5);
            after->covariance[53] = after->covariance[53] + (p_1_8 * n_5);
            after->covariance[54] = after->covariance[54] + (p_1_9 * n_5);
            after->covariance[55] = after->covariance[55] + (p_1_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_1_11 * n_5);
            after->covariance[57] = after->covariance[57] + (p_1_6 * n_6);
            after->covariance[58] = after->covariance[58] + (p_1_7 * n_6);
            after->covariance[59] = after->covariance[59] + (p_1_8 * n_6);
            after->covariance[60] = after->covariance[60] + (p_1_9 * n_6);
            after->covariance[61] = after->covariance[61] + (p_1_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_1_11 * n_6);
            after->covariance[63] = after->covariance[63] + (p_1_7 * n_7);
            after->covariance[64] = after->covariance[64] + (p_1_8 * n_7);
            after->covariance[65] = after->covariance[65] + (p_1_9 * n_7);
            after->covariance[66] = after->covariance[66] + (p_1_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_1_11 * n_7);
            after->covariance[68] = after->covariance[68] + (p_1_8 * n_8);
            after->covariance[69] = after->covariance[69] + (p_1_9 * n_8);
            after->covariance[70] = after->covariance[70] + (p_1_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_1_11 * n_8);
            after->covariance[72] = after->covariance[72] + (p_1_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_1_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_1_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_1_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_1_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_1_11 * n_11);
            const double delta_1 = delta[1];
            const double e = residual_1 - delta_1;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta_1 + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[1] = s;
        }

        /* row 2: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_2 = after->covariance[2];
            const double r_2 = params->variance_pose[2];
            const double p_2_2 = after->covariance[23];
            const double s = r_2 + p_2_2;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_2 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_2 * n_0);
            const double p_1_2 = after->covariance[13];
            after->covariance[1] = after->covariance[1] + (p_1_2 * n_0);
            const double minus_r = -r_2;
            after->covariance[2] = n_0 * minus_r;
            const double p_2_3 = after->covariance[24];
            after->covariance[3] = after->covariance[3] + (p_2_3 * n_0);
            const double p_2_4 = after->covariance[25];
            after->covariance[4] = after->covariance[4] + (p_2_4 * n_0);
            const double p_2_5 = after->covariance[26];
            after->covariance[5] = after->covariance[5] + (p_2_5 * n_0);
            const double p_2_6 = after->covariance[27];
            after->covariance[6] = after->covariance[6] + (p_2_6 * n_0);
            const double p_2_7 = after->covariance[28];
            after->covariance[7] = after->covariance[7] + (p_2_7 * n_0);
            const double p_2_8 = after->covariance[29];
            after->covariance[8] = after->covariance[8] + (p_2_8 * n_0);
            const double p_2_9 = after->covariance[30];
            after->covariance[9] = after->covariance[9] + (p_2_9 * n_0);
            const double p_2_10 = after->covariance[31];
            after->covariance[10] = after->covariance[10] + (p_2_10 * n_0);
            const double p_2_11 = after->covariance[32];
            after->covariance[11] = after->covariance[11] + (p_2_11 * n_0);
            const double n_1 = p_1_2 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_2 * n_1);
            after->covariance[13] = n_1 * minus_r;
            after->covariance[14] = after->covariance[14] + (p_2_3 * n_1);
            after->covariance[15] = after->covariance[15] + (p_2_4 * n_1);
            after->covariance[16] = after->covariance[16] + (p_2_5 * n_1);
            after->covariance[17] = after->covariance[17] + (p_2_6 * n_1);
            after->covariance[18] = after->covariance[18] + (p_2_7 * n_1);
            after->covariance[19] = after->covariance[19] + (p_2_8 * n_1);
            after->covariance[20] = after->covariance[20] + (p_2_9 * n_1);
            after->covariance[21] = after->covariance[21] + (p_2_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_2_11 * n_1);
            const double n_2 = p_2_2 * minus_per_s;
            after->covariance[23] = n_2 * minus_r;
            const double n_3 = p_2_3 * minus_per_s;
            after->covariance[24] = n_3 * minus_r;
            const double n_4 = p_2_4 * minus_per_s;
            after->covariance[25] = n_4 * minus_r;
            const double n_5 = p_2_5 * minus_per_s;
            after->covariance[26] = n_5 * minus_r;
            const double n_6 = p_2_6 * minus_per_s;
            after->covariance[27] = n_6 * minus_r;
            const double n_7 = p_2_7 * minus_per_s;
            after->covariance[28] = n_7 * minus_r;
            const double n_8 = p_2_8 * minus_per_s;
            after->covariance[29] = n_8 * minus_r;
            const double n_9 = p_2_9 * minus_per_s;
            after->covariance[30] = n_9 * minus_r;
            const double n_10 = p_2_10 * minus_per_s;
            after->covariance[31] = n_10 * minus_r;
            const double n_11 = p_2_11 * minus_per_s;
            after->covariance[32] = n_11 * minus_r;
            after->covariance[33] = after->covariance[33] + (p_2_3 * n_3);
            after->covariance[34] = after->covariance[34] + (p_2_4 * n_3);
            after->covariance[35] = after->covariance[35] + (p_2_5 * n_3);
            after->covariance[36] = after->covariance[36] + (p_2_6 * n_3);
            after->covariance[37] = after->covariance[37] + (p_2_7 * n_3);
            after->covariance[38] = after->covariance[38] + (p_2_8 * n_3);
            after->covariance[39] = after->covariance[39] + (p_2_9 * n_3);
            after->covariance[40] = after->covariance[40] + (p_2_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_2_11 * n_3);
            after->covariance[42] = after->covariance[42] + (p_2_4 * n_4);
            after->covariance[43] = after->covariance[43] + (p_2_5 * n_4);
            after->covariance[44] = after->covariance[44] + (p_2_6 * n_4);
            after->covariance[45] = after->covariance[45] + (p_2_7 * n_4);
            after->covariance[46] = after->covariance[46] + (p_2_8 * n_4);
            after->covariance[47] = after->covariance[47] + (p_2_9 * n_4);
            after->covariance[48] = after->covariance[48] + (p_2_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_2_11 * n_4);
            after->covariance[50] = after->covariance[50] + (p_2_5 * n_5);
            after->covariance[51] = after->covariance[51] + (p_2_6 * n_5);
            after->covariance[52] = after->covariance[52] + (p_2_7 * n_5);
            after->covariance[53] = after->covariance[53] + (p_2_8 * n_5);
            after->covariance[54] = after->covariance[54] + (p_2_9 * n_5);
            after->covariance[55] = after->covariance[55] + (p_2_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_2_11 * n_5);
            after->covariance[57] = after->covariance[57] + (p_2_6 * n_6);
            after->covariance[58] = after->covariance[58] + (p_2_7 * n_6);
            after->covariance[59] = after->covariance[59] + (p_2_8 * n_6);
            after->covariance[60] = after->covariance[60] + (p_2_9 * n_6);
            after->covariance[61] = after->covariance[61] + (p_2_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_2_11 * n_6);
            after->covariance[63] = after->covariance[63] + (p_2_7 * n_7);
            after->covariance[64] = after->covariance[64] + (p_2_8 * n_7);
            after->covariance[65] = after->covariance[65] + (p_2_9 * n_7);
            after->covariance[66] = after->covariance[66] + (p_2_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_2_11 * n_7);
            after->covariance[68] = after->covariance[68] + (p_2_8 * n_8);
            after->covariance[69] = after->covariance[69] + (p_2_9 * n_8);
            after->covariance[70] = after->covariance[70] + (p_2_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_2_11 * n_8);
            after->covariance[72] = after->covariance[72] + (p_2_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_2_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_2_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_2_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_2_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_2_11 * n_11);
            const double delta_2 = delta[2];
            const double e = residual_2 - delta_2;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta_2 + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[2] = s;
        }

        /* row 3: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_3 = after->covariance[3];
            const double r_3 = params->variance_pose[3];
            const double p_3_3 = after->covariance[33];
            const double s = r_3 + p_3_3;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_3 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_3 * n_0);
            const double p_1_3 = after->covariance[14];
            after->covariance[1] = after->covariance[1] + (p_1_3 * n_0);
            const double p_2_3 = after->covariance[24];
            after->covariance[2] = after->covariance[2] + (p_2_3 * n_0);
            const double minus_r = -r_3;
            after->covariance[3] = n_0 * minus_r;
            const double p_3_4 = after->covariance[34];
            after->covariance[4] = after->covariance[4] + (p_3_4 * n_0);
            const double p_3_5 = after->covariance[35];
            after->covariance[5] = after->covariance[5] + (p_3_5 * n_0);
            const double p_3_6 = after->covariance[36];
            after->covariance[6] = after->covariance[6] + (p_3_6 * n_0);
            const double p_3_7 = after->covariance[37];
            after->covariance[7] = after->covariance[7] + (p_3_7 * n_0);
            const double p_3_8 = after->covariance[38];
            after->covariance[8] = after->covariance[8] + (p_3_8 * n_0);
            const double p_3_9 = after->covariance[39];
            after->covariance[9] = after->covariance[9] + (p_3_9 * n_0);
            const double p_3_10 = after->covariance[40];
            after->covariance[10] = after->covariance[10] + (p_3_10 * n_0);
            const double p_3_11 = after->covariance[41];
            after->covariance[11] = after->covariance[11] + (p_3_11 * n_0);
            const double n_1 = p_1_3 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_3 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_3 * n_1);
            after->covariance[14] = n_1 * minus_r;
            after->covariance[15] = after->covariance[15] + (p_3_4 * n_1);
            after->covariance[16] = after->covariance[16] + (p_3_5 * n_1);
            after->covariance[17] = after->covariance[17] + (p_3_6 * n_1);
            after->covariance[18] = after->covariance[18] + (p_3_7 * n_1);
            after->covariance[19] = after->covariance[19] + (p_3_8 * n_1);
            after->covariance[20] = after->covariance[20] + (p_3_9 * n_1);
            after->covariance[21] = after->covariance[21] + (p_3_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_3_11 * n_1);
            const double n_2 = p_2_3 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_3 * n_2);
            after->covariance[24] = n_2 * minus_r;
            after->covariance[25] = after->covariance[25] + (p_3_4 * n_2);
            after->covariance[26] = after->covariance[26] + (p_3_5 * n_2);
            after->covariance[27] = after->covariance[27] + (p_3_6 * n_2);
            after->covariance[28] = after->covariance[28] + (p_3_7 * n_2);
            after->covariance[29] = after->covariance[29] + (p_3_8 * n_2);
            after->covariance[30] = after->covariance[30] + (p_3_9 * n_2);
            after->covariance[31] = after->covariance[31] + (p_3_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_3_11 * n_2);
            const double n_3 = p_3_3 * minus_per_s;
            after->covariance[33] = n_3 * minus_r;
            const double n_4 = p_3_4 * minus_per_s;
            after->covariance[34] = n_4 * minus_r;
            const double n_5 = p_3_5 * minus_per_s;
            after->covariance[35] = n_5 * minus_r;
            const double n_6 = p_3_6 * minus_per_s;
            after->covariance[36] = n_6 * minus_r;
            const double n_7 = p_3_7 * minus_per_s;
            after->covariance[37] = n_7 * minus_r;
            const double n_8 = p_3_8 * minus_per_s;
            after->covariance[38] = n_8 * minus_r;
            const double n_9 = p_3_9 * minus_per_s;
            after->covariance[39] = n_9 * minus_r;
            const double n_10 = p_3_10 * minus_per_s;
            after->covariance[40] = n_10 * minus_r;
            const double n_11 = p_3_11 * minus_per_s;
            after->covariance[41] = n_11 * minus_r;
            after->covariance[42] = after->covariance[42] + (p_3_4 * n_4);
            after->covariance[43] = after->covariance[43] + (p_3_5 * n_4);
            after->covariance[44] = after->covariance[44] + (p_3_6 * n_4);
            after->covariance[45] = after->covariance[45] + (p_3_7 * n_4);
            after->covariance[46] = after->covariance[46] + (p_3_8 * n_4);
            after->covariance[47] = after->covariance[47] + (p_3_9 * n_4);
            after->covariance[48] = after->covariance[48] + (p_3_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_3_11 * n_4);
            after->covariance[50] = after->covariance[50] + (p_3_5 * n_5);
            after->covariance[51] = after->covariance[51] + (p_3_6 * n_5);
            after->covariance[52] = after->covariance[52] + (p_3_7 * n_5);
            after->covariance[53] = after->covariance[53] + (p_3_8 * n_5);
            after->covariance[54] = after->covariance[54] + (p_3_9 * n_5);
            after->covariance[55] = after->covariance[55] + (p_3_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_3_11 * n_5);
            after->covariance[57] = after->covariance[57] + (p_3_6 * n_6);
            after->covariance[58] = after->covariance[58] + (p_3_7 * n_6);
            after->covariance[59] = after->covariance[59] + (p_3_8 * n_6);
            after->covariance[60] = after->covariance[60] + (p_3_9 * n_6);
            after->covariance[61] = after->covariance[61] + (p_3_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_3_11 * n_6);
            after->covariance[63] = after->covariance[63] + (p_3_7 * n_7);
            after->covariance[64] = after->covariance[64] + (p_3_8 * n_7);
            after->covariance[65] = after->covariance[65] + (p_3_9 * n_7);
            after->covariance[66] = after->covariance[66] + (p_3_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_3_11 * n_7);
            after->covariance[68] = after->covariance[68] + (p_3_8 * n_8);
            after->covariance[69] = after->covariance[69] + (p_3_9 * n_8);
            after->covariance[70] = after->covariance[70] + (p_3_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_3_11 * n_8);
            after->covariance[72] = after->covariance[72] + (p_3_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_3_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_3_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_3_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_3_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_3_11 * n_11);
            const double delta_3 = delta[3];
            const double e = residual_3 - delta_3;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta_3 + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[3] = s;
        }

        /* row 4: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_4 = after->covariance[4];
            const double r_4 = params->variance_pose[4];
            const double p_4_4 = after->covariance[42];
            const double s = r_4 + p_4_4;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_4 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_4 * n_0);
            const double p_1_4 = after->covariance[15];
            after->covariance[1] = after->covariance[1] + (p_1_4 * n_0);
            const double p_2_4 = after->covariance[25];
            after->covariance[2] = after->covariance[2] + (p_2_4 * n_0);
            const double p_3_4 = after->covariance[34];
            after->covariance[3] = after->covariance[3] + (p_3_4 * n_0);
            const double minus_r = -r_4;
            after->covariance[4] = n_0 * minus_r;
            const double p_4_5 = after->covariance[43];
            after->covariance[5] = after->covariance[5] + (p_4_5 * n_0);
            const double p_4_6 = after->covariance[44];
            after->covariance[6] = after->covariance[6] + (p_4_6 * n_0);
            const double p_4_7 = after->covariance[45];
            after->covariance[7] = after->covariance[7] + (p_4_7 * n_0);
            const double p_4_8 = after->covariance[46];
            after->covariance[8] = after->covariance[8] + (p_4_8 * n_0);
            const double p_4_9 = after->covariance[47];
            after->covariance[9] = after->covariance[9] + (p_4_9 * n_0);
            const double p_4_10 = after->covariance[48];
            after->covariance[10] = after->covariance[10] + (p_4_10 * n_0);
            const double p_4_11 = after->covariance[49];
            after->covariance[11] = after->covariance[11] + (p_4_11 * n_0);
            const double n_1 = p_1_4 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_4 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_4 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_4 * n_1);
            after->covariance[15] = n_1 * minus_r;
            after->covariance[16] = after->covariance[16] + (p_4_5 * n_1);
            after->covariance[17] = after->covariance[17] + (p_4_6 * n_1);
            after->covariance[18] = after->covariance[18] + (p_4_7 * n_1);
            after->covariance[19] = after->covariance[19] + (p_4_8 * n_1);
            after->covariance[20] = after->covariance[20] + (p_4_9 * n_1);
            after->covariance[21] = after->covariance[21] + (p_4_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_4_11 * n_1);
            const double n_2 = p_2_4 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_4 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_4 * n_2);
            after->covariance[25] = n_2 * minus_r;
            after->covariance[26] = after->covariance[26] + (p_4_5 * n_2);
            after->covariance[27] = after->covariance[27] + (p_4_6 * n_2);
            after->covariance[28] = after->covariance[28] + (p_4_7 * n_2);
            after->covariance[29] = after->covariance[29] + (p_4_8 * n_2);
            after->covariance[30] = after->covariance[30] + (p_4_9 * n_2);
            after->covariance[31] = after->covariance[31] + (p_4_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_4_11 * n_2);
            const double n_3 = p_3_4 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_4 * n_3);
            after->covariance[34] = n_3 * minus_r;
            after->covariance[35] = after->covariance[35] + (p_4_5 * n_3);
            after->covariance[36] = after->covariance[36] + (p_4_6 * n_3);
            after->covariance[37] = after->covariance[37] + (p_4_7 * n_3);
            after->covariance[38] = after->covariance[38] + (p_4_8 * n_3);
            after->covariance[39] = after->covariance[39] + (p_4_9 * n_3);
            after->covariance[40] = after->covariance[40] + (p_4_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_4_11 * n_3);
            const double n_4 = p_4_4 * minus_per_s;
            after->covariance[42] = n_4 * minus_r;
            const double n_5 = p_4_5 * minus_per_s;
            after->covariance[43] = n_5 * minus_r;
            const double n_6 = p_4_6 * minus_per_s;
            after->covariance[44] = n_6 * minus_r;
            const double n_7 = p_4_7 * minus_per_s;
            after->covariance[45] = n_7 * minus_r;
            const double n_8 = p_4_8 * minus_per_s;
            after->covariance[46] = n_8 * minus_r;
            const double n_9 = p_4_9 * minus_per_s;
            after->covariance[47] = n_9 * minus_r;
            const double n_10 = p_4_10 * minus_per_s;
            after->covariance[48] = n_10 * minus_r;
            const double n_11 = p_4_11 * minus_per_s;
            after->covariance[49] = n_11 * minus_r;
            after->covariance[50] = after->covariance[50] + (p_4_5 * n_5);
            after->covariance[51] = after->covariance[51] + (p_4_6 * n_5);
            after->covariance[52] = after->covariance[52] + (p_4_7 * n_5);
            after->covariance[53] = after->covariance[53] + (p_4_8 * n_5);
            after->covariance[54] = after->covariance[54] + (p_4_9 * n_5);
            after->covariance[55] = after->covariance[55] + (p_4_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_4_11 * n_5);
            after->covariance[57] = after->covariance[57] + (p_4_6 * n_6);
            after->covariance[58] = after->covariance[58] + (p_4_7 * n_6);
            after->covariance[59] = after->covariance[59] + (p_4_8 * n_6);
            after->covariance[60] = after->covariance[60] + (p_4_9 * n_6);
            after->covariance[61] = after->covariance[61] + (p_4_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_4_11 * n_6);
            after->covariance[63] = after->covariance[63] + (p_4_7 * n_7);
            after->covariance[64] = after->covariance[64] + (p_4_8 * n_7);
            after->covariance[65] = after->covariance[65] + (p_4_9 * n_7);
            after->covariance[66] = after->covariance[66] + (p_4_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_4_11 * n_7);
            after->covariance[68] = after->covariance[68] + (p_4_8 * n_8);
            after->covariance[69] = after->covariance[69] + (p_4_9 * n_8);
            after->covariance[70] = after->covariance[70] + (p_4_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_4_11 * n_8);
            after->covariance[72] = after->covariance[72] + (p_4_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_4_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_4_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_4_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_4_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_4_11 * n_11);
            const double delta_4 = delta[4];
            const double e = residual_4 - delta_4;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta_4 + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[4] = s;
        }

        /* row 5: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_5 = after->covariance[5];
            const double r_5 = params->variance_pose[5];
            const double p_5_5 = after->covariance[50];
            const double s = r_5 + p_5_5;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_5 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_5 * n_0);
            const double p_1_5 = after->covariance[16];
            after->covariance[1] = after->covariance[1] + (p_1_5 * n_0);
            const double p_2_5 = after->covariance[26];
            after->covariance[2] = after->covariance[2] + (p_2_5 * n_0);
            const double p_3_5 = after->covariance[35];
            after->covariance[3] = after->covariance[3] + (p_3_5 * n_0);
            const double p_4_5 = after->covariance[43];
            after->covariance[4] = after->covariance[4] + (p_4_5 * n_0);
            const double minus_r = -r_5;
            after->covariance[5] = n_0 * minus_r;
            const double p_5_6 = after->covariance[51];
            after->covariance[6] = after->covariance[6] + (p_5_6 * n_0);
            const double p_5_7 = after->covariance[52];
            after->covariance[7] = after->covariance[7] + (p_5_7 * n_0);
            const double p_5_8 = after->covariance[53];
            after->covariance[8] = after->covariance[8] + (p_5_8 * n_0);
            const double p_5_9 = after->covariance[54];
            after->covariance[9] = after->covariance[9] + (p_5_9 * n_0);
            const double p_5_10 = after->covariance[55];
            after->covariance[10] = after->covariance[10] + (p_5_10 * n_0);
            const double p_5_11 = after->covariance[56];
            after->covariance[11] = after->covariance[11] + (p_5_11 * n_0);
            const double n_1 = p_1_5 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_5 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_5 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_5 * n_1);
            after->covariance[15] = after->covariance[15] + (p_4_5 * n_1);
            after->covariance[16] = n_1 * minus_r;
            after->covariance[17] = after->covariance[17] + (p_5_6 * n_1);
            after->covariance[18] = after->covariance[18] + (p_5_7 * n_1);
            after->covariance[19] = after->covariance[19] + (p_5_8 * n_1);
            after->covariance[20] = after->covariance[20] + (p_5_9 * n_1);
            after->covariance[21] = after->covariance[21] + (p_5_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_5_11 * n_1);
            const double n_2 = p_2_5 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_5 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_5 * n_2);
            after->covariance[25] = after->covariance[25] + (p_4_5 * n_2);
            after->covariance[26] = n_2 * minus_r;
            after->covariance[27] = after->covariance[27] + (p_5_6 * n_2);
            after->covariance[28] = after->covariance[28] + (p_5_7 * n_2);
            after->covariance[29] = after->covariance[29] + (p_5_8 * n_2);
            after->covariance[30] = after->covariance[30] + (p_5_9 * n_2);
            after->covariance[31] = after->covariance[31] + (p_5_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_5_11 * n_2);
            const double n_3 = p_3_5 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_5 * n_3);
            after->covariance[34] = after->covariance[34] + (p_4_5 * n_3);
            after->covariance[35] = n_3 * minus_r;
            after->covariance[36] = after->covariance[36] + (p_5_6 * n_3);
            after->covariance[37] = after->covariance[37] + (p_5_7 * n_3);
            after->covariance[38] = after->covariance[38] + (p_5_8 * n_3);
            after->covariance[39] = after->covariance[39] + (p_5_9 * n_3);
            after->covariance[40] = after->covariance[40] + (p_5_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_5_11 * n_3);
            const double n_4 = p_4_5 * minus_per_s;
            after->covariance[42] = after->covariance[42] + (p_4_5 * n_4);
            after->covariance[43] = n_4 * minus_r;
            after->covariance[44] = after->covariance[44] + (p_5_6 * n_4);
            after->covariance[45] = after->covariance[45] + (p_5_7 * n_4);
            after->covariance[46] = after->covariance[46] + (p_5_8 * n_4);
            after->covariance[47] = after->covariance[47] + (p_5_9 * n_4);
            after->covariance[48] = after->covariance[48] + (p_5_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_5_11 * n_4);
            const double n_5 = p_5_5 * minus_per_s;
            after->covariance[50] = n_5 * minus_r;
            const double n_6 = p_5_6 * minus_per_s;
            after->covariance[51] = n_6 * minus_r;
            const double n_7 = p_5_7 * minus_per_s;
            after->covariance[52] = n_7 * minus_r;
            const double n_8 = p_5_8 * minus_per_s;
            after->covariance[53] = n_8 * minus_r;
            const double n_9 = p_5_9 * minus_per_s;
            after->covariance[54] = n_9 * minus_r;
            const double n_10 = p_5_10 * minus_per_s;
            after->covariance[55] = n_10 * minus_r;
            const double n_11 = p_5_11 * minus_per_s;
            after->covariance[56] = n_11 * minus_r;
            after->covariance[57] = after->covariance[57] + (p_5_6 * n_6);
            after->covariance[58] = after->covariance[58] + (p_5_7 * n_6);
            after->covariance[59] = after->covariance[59] + (p_5_8 * n_6);
            after->covariance[60] = after->covariance[60] + (p_5_9 * n_6);
            after->covariance[61] = after->covariance[61] + (p_5_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_5_11 * n_6);
            after->covariance[63] = after->covariance[63] + (p_5_7 * n_7);
            after->covariance[64] = after->covariance[64] + (p_5_8 * n_7);
            after->covariance[65] = after->covariance[65] + (p_5_9 * n_7);
            after->covariance[66] = after->covariance[66] + (p_5_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_5_11 * n_7);
            after->covariance[68] = after->covariance[68] + (p_5_8 * n_8);
            after->covariance[69] = after->covariance[69] + (p_5_9 * n_8);
            after->covariance[70] = after->covariance[70] + (p_5_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_5_11 * n_8);
            after->covariance[72] = after->covariance[72] + (p_5_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_5_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_5_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_5_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_5_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_5_11 * n_11);
            const double delta_5 = delta[5];
            const double e = residual_5 - delta_5;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta_5 + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[5] = s;
        }

        /* row 6: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_6 = after->covariance[6];
            const double r_6 = params->variance_pose[6];
            const double p_6_6 = after->covariance[57];
            const double s = r_6 + p_6_6;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_6 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_6 * n_0);
            const double p_1_6 = after->covariance[17];
            after->covariance[1] = after->covariance[1] + (p_1_6 * n_0);
            const double p_2_6 = after->covariance[27];
            after->covariance[2] = after->covariance[2] + (p_2_6 * n_0);
            const double p_3_6 = after->covariance[36];
            after->covariance[3] = after->covariance[3] + (p_3_6 * n_0);
            const double p_4_6 = after->covariance[44];
            after->covariance[4] = after->covariance[4] + (p_4_6 * n_0);
            const double p_5_6 = after->covariance[51];
            after->covariance[5] = after->covariance[5] + (p_5_6 * n_0);
            const double minus_r = -r_6;
            after->covariance[6] = n_0 * minus_r;
            const double p_6_7 = after->covariance[58];
            after->covariance[7] = after->covariance[7] + (p_6_7 * n_0);
            const double p_6_8 = after->covariance[59];
            after->covariance[8] = after->covariance[8] + (p_6_8 * n_0);
            const double p_6_9 = after->covariance[60];
            after->covariance[9] = after->covariance[9] + (p_6_9 * n_0);
            const double p_6_10 = after->covariance[61];
            after->covariance[10] = after->covariance[10] + (p_6_10 * n_0);
            const double p_6_11 = after->covariance[62];
            after->covariance[11] = after->covariance[11] + (p_6_11 * n_0);
            const double n_1 = p_1_6 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_6 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_6 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_6 * n_1);
            after->covariance[15] = after->covariance[15] + (p_4_6 * n_1);
            after->covariance[16] = after->covariance[16] + (p_5_6 * n_1);
            after->covariance[17] = n_1 * minus_r;
            after->covariance[18] = after->covariance[18] + (p_6_7 * n_1);
            after->covariance[19] = after->covariance[19] + (p_6_8 * n_1);
            after->covariance[20] = after->covariance[20] + (p_6_9 * n_1);
            after->covariance[21] = after->covariance[21] + (p_6_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_6_11 * n_1);
            const double n_2 = p_2_6 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_6 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_6 * n_2);
            after->covariance[25] = after->covariance[25] + (p_4_6 * n_2);
            after->covariance[26] = after->covariance[26] + (p_5_6 * n_2);
            after->covariance[27] = n_2 * minus_r;
            after->covariance[28] = after->covariance[28] + (p_6_7 * n_2);
            after->covariance[29] = after->covariance[29] + (p_6_8 * n_2);
            after->covariance[30] = after->covariance[30] + (p_6_9 * n_2);
            after->covariance[31] = after->covariance[31] + (p_6_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_6_11 * n_2);
            const double n_3 = p_3_6 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_6 * n_3);
            after->covariance[34] = after->covariance[34] + (p_4_6 * n_3);
            after->covariance[35] = after->covariance[35] + (p_5_6 * n_3);
            after->covariance[36] = n_3 * minus_r;
            after->covariance[37] = after->covariance[37] + (p_6_7 * n_3);
            after->covariance[38] = after->covariance[38] + (p_6_8 * n_3);
            after->covariance[39] = after->covariance[39] + (p_6_9 * n_3);
            after->covariance[40] = after->covariance[40] + (p_6_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_6_11 * n_3);
            const double n_4 = p_4_6 * minus_per_s;
            after->covariance[42] = after->covariance[42] + (p_4_6 * n_4);
            after->covariance[43] = after->covariance[43] + (p_5_6 * n_4);
            after->covariance[44] = n_4 * minus_r;
            after->covariance[45] = after->covariance[45] + (p_6_7 * n_4);
            after->covariance[46] = after->covariance[46] + (p_6_8 * n_4);
            after->covariance[47] = after->covariance[47] + (p_6_9 * n_4);
            after->covariance[48] = after->covariance[48] + (p_6_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_6_11 * n_4);
            const double n_5 = p_5_6 * minus_per_s;
            after->covariance[50] = after->covariance[50] + (p_5_6 * n_5);
            after->covariance[51] = n_5 * minus_r;
            after->covariance[52] = after->covariance[52] + (p_6_7 * n_5);
            after->covariance[53] = after->covariance[53] + (p_6_8 * n_5);
            after->covariance[54] = after->covariance[54] + (p_6_9 * n_5);
            after->covariance[55] = after->covariance[55] + (p_6_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_6_11 * n_5);
            const double n_6 = p_6_6 * minus_per_s;
            after->covariance[57] = n_6 * minus_r;
            const double n_7 = p_6_7 * minus_per_s;
            after->covariance[58] = n_7 * minus_r;
            const double n_8 = p_6_8 * minus_per_s;
            after->covariance[59] = n_8 * minus_r;
            const double n_9 = p_6_9 * minus_per_s;
            after->covariance[60] = n_9 * minus_r;
            const double n_10 = p_6_10 * minus_per_s;
            after->covariance[61] = n_10 * minus_r;
            const double n_11 = p_6_11 * minus_per_s;
            after->covariance[62] = n_11 * minus_r;
            after->covariance[63] = after->covariance[63] + (p_6_7 * n_7);
            after->covariance[64] = after->covariance[64] + (p_6_8 * n_7);
            after->covariance[65] = after->covariance[65] + (p_6_9 * n_7);
            after->covariance[66] = after->covariance[66] + (p_6_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_6_11 * n_7);
            after->covariance[68] = after->covariance[68] + (p_6_8 * n_8);
            after->covariance[69] = after->covariance[69] + (p_6_9 * n_8);
            after->covariance[70] = after->covariance[70] + (p_6_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_6_11 * n_8);
            after->covariance[72] = after->covariance[72] + (p_6_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_6_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_6_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_6_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_6_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_6_11 * n_11);
            const double delta_6 = delta[6];
            const double e = residual_6 - delta_6;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta_6 + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[6] = s;
        }

        /* row 7: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_7 = after->covariance[7];
            const double r_7 = params->variance_pose[7];
            const double p_7_7 = after->covariance[63];
            const double s = r_7 + p_7_7;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_7 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_7 * n_0);
            const double p_1_7 = after->covariance[18];
            after->covariance[1] = after->covariance[1] + (p_1_7 * n_0);
            const double p_2_7 = after->covariance[28];
            after->covariance[2] = after->covariance[2] + (p_2_7 * n_0);
            const double p_3_7 = after->covariance[37];
            after->covariance[3] = after->covariance[3] + (p_3_7 * n_0);
            const double p_4_7 = after->covariance[45];
            after->covariance[4] = after->covariance[4] + (p_4_7 * n_0);
            const double p_5_7 = after->covariance[52];
            after->covariance[5] = after->covariance[5] + (p_5_7 * n_0);
            const double p_6_7 = after->covariance[58];
            after->covariance[6] = after->covariance[6] + (p_6_7 * n_0);
            const double minus_r = -r_7;
            after->covariance[7] = n_0 * minus_r;
            const double p_7_8 = after->covariance[64];
            after->covariance[8] = after->covariance[8] + (p_7_8 * n_0);
            const double p_7_9 = after->covariance[65];
            after->covariance[9] = after->covariance[9] + (p_7_9 * n_0);
            const double p_7_10 = after->covariance[66];
            after->covariance[10] = after->covariance[10] + (p_7_10 * n_0);
            const double p_7_11 = after->covariance[67];
            after->covariance[11] = after->covariance[11] + (p_7_11 * n_0);
            const double n_1 = p_1_7 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_7 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_7 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_7 * n_1);
            after->covariance[15] = after->covariance[15] + (p_4_7 * n_1);
            after->covariance[16] = after->covariance[16] + (p_5_7 * n_1);
            after->covariance[17] = after->covariance[17] + (p_6_7 * n_1);
            after->covariance[18] = n_1 * minus_r;
            after->covariance[19] = after->covariance[19] + (p_7_8 * n_1);
            after->covariance[20] = after->covariance[20] + (p_7_9 * n_1);
            after->covariance[21] = after->covariance[21] + (p_7_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_7_11 * n_1);
            const double n_2 = p_2_7 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_7 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_7 * n_2);
            after->covariance[25] = after->covariance[25] + (p_4_7 * n_2);
            after->covariance[26] = after->covariance[26] + (p_5_7 * n_2);
            after->covariance[27] = after->covariance[27] + (p_6_7 * n_2);
            after->covariance[28] = n_2 * minus_r;
            after->covariance[29] = after->covariance[29] + (p_7_8 * n_2);
            after->covariance[30] = after->covariance[30] + (p_7_9 * n_2);
            after->covariance[31] = after->covariance[31] + (p_7_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_7_11 * n_2);
            const double n_3 = p_3_7 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_7 * n_3);
            after->covariance[34] = after->covariance[34] + (p_4_7 * n_3);
            after->covariance[35] = after->covariance[35] + (p_5_7 * n_3);
            after->covariance[36] = after->covariance[36] + (p_6_7 * n_3);
            after->covariance[37] = n_3 * minus_r;
            after->covariance[38] = after->covariance[38] + (p_7_8 * n_3);
            after->covariance[39] = after->covariance[39] + (p_7_9 * n_3);
            after->covariance[40] = after->covariance[40] + (p_7_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_7_11 * n_3);
            const double n_4 = p_4_7 * minus_per_s;
            after->covariance[42] = after->covariance[42] + (p_4_7 * n_4);
            after->covariance[43] = after->covariance[43] + (p_5_7 * n_4);
            after->covariance[44] = after->covariance[44] + (p_6_7 * n_4);
            after->covariance[45] = n_4 * minus_r;
            after->covariance[46] = after->covariance[46] + (p_7_8 * n_4);
            after->covariance[47] = after->covariance[47] + (p_7_9 * n_4);
            after->covariance[48] = after->covariance[48] + (p_7_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_7_11 * n_4);
            const double n_5 = p_5_7 * minus_per_s;
            after->covariance[50] = after->covariance[50] + (p_5_7 * n_5);
            after->covariance[51] = after->covariance[51] + (p_6_7 * n_5);
            after->covariance[52] = n_5 * minus_r;
            after->covariance[53] = after->covariance[53] + (p_7_8 * n_5);
            after->covariance[54] = after->covariance[54] + (p_7_9 * n_5);
            after->covariance[55] = after->covariance[55] + (p_7_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_7_11 * n_5);
            const double n_6 = p_6_7 * minus_per_s;
            after->covariance[57] = after->covariance[57] + (p_6_7 * n_6);
            after->covariance[58] = n_6 * minus_r;
            after->covariance[59] = after->covariance[59] + (p_7_8 * n_6);
            after->covariance[60] = after->covariance[60] + (p_7_9 * n_6);
            after->covariance[61] = after->covariance[61] + (p_7_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_7_11 * n_6);
            const double n_7 = p_7_7 * minus_per_s;
            after->covariance[63] = n_7 * minus_r;
            const double n_8 = p_7_8 * minus_per_s;
            after->covariance[64] = n_8 * minus_r;
            const double n_9 = p_7_9 * minus_per_s;
            after->covariance[65] = n_9 * minus_r;
            const double n_10 = p_7_10 * minus_per_s;
            after->covariance[66] = n_10 * minus_r;
            const double n_11 = p_7_11 * minus_per_s;
            after->covariance[67] = n_11 * minus_r;
            after->covariance[68] = after->covariance[68] + (p_7_8 * n_8);
            after->covariance[69] = after->covariance[69] + (p_7_9 * n_8);
            after->covariance[70] = after->covariance[70] + (p_7_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_7_11 * n_8);
            after->covariance[72] = after->covariance[72] + (p_7_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_7_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_7_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_7_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_7_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_7_11 * n_11);
            const double delta_7 = delta[7];
            const double e = residual_7 - delta_7;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta_7 + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[7] = s;
        }

        /* row 8: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_8 = after->covariance[8];
            const double r_8 = params->variance_pose[8];
            const double p_8_8 = after->covariance[68];
            const double s = r_8 + p_8_8;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_8 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_8 * n_0);
            const double p_1_8 = after->covariance[19];
            after->covariance[1] = after->covariance[1] + (p_1_8 * n_0);
            const double p_2_8 = after->covariance[29];
            after->covariance[2] = after->covariance[2] + (p_2_8 * n_0);
            const double p_3_8 = after->covariance[38];
            after->covariance[3] = after->covariance[3] + (p_3_8 * n_0);
            const double p_4_8 = after->covariance[46];
            after->covariance[4] = after->covariance[4] + (p_4_8 * n_0);
            const double p_5_8 = after->covariance[53];
            after->covariance[5] = after->covariance[5] + (p_5_8 * n_0);
            const double p_6_8 = after->covariance[59];
            after->covariance[6] = after->covariance[6] + (p_6_8 * n_0);
            const double p_7_8 = after->covariance[64];
            after->covariance[7] = after->covariance[7] + (p_7_8 * n_0);
            const double minus_r = -r_8;
            after->covariance[8] = n_0 * minus_r;
            const double p_8_9 = after->covariance[69];
            after->covariance[9] = after->covariance[9] + (p_8_9 * n_0);
            const double p_8_10 = after->covariance[70];
            after->covariance[10] = after->covariance[10] + (p_8_10 * n_0);
            const double p_8_11 = after->covariance[71];
            after->covariance[11] = after->covariance[11] + (p_8_11 * n_0);
            const double n_1 = p_1_8 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_8 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_8 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_8 * n_1);
            after->covariance[15] = after->covariance[15] + (p_4_8 * n_1);
            after->covariance[16] = after->covariance[16] + (p_5_8 * n_1);
            after->covariance[17] = after->covariance[17] + (p_6_8 * n_1);
            after->covariance[18] = after->covariance[18] + (p_7_8 * n_1);
            after->covariance[19] = n_1 * minus_r;
            after->covariance[20] = after->covariance[20] + (p_8_9 * n_1);
            after->covariance[21] = after->covariance[21] + (p_8_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_8_11 * n_1);
            const double n_2 = p_2_8 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_8 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_8 * n_2);
            after->covariance[25] = after->covariance[25] + (p_4_8 * n_2);
            after->covariance[26] = after->covariance[26] + (p_5_8 * n_2);
            after->covariance[27] = after->covariance[27] + (p_6_8 * n_2);
            after->covariance[28] = after->covariance[28] + (p_7_8 * n_2);
            after->covariance[29] = n_2 * minus_r;
            after->covariance[30] = after->covariance[30] + (p_8_9 * n_2);
            after->covariance[31] = after->covariance[31] + (p_8_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_8_11 * n_2);
            const double n_3 = p_3_8 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_8 * n_3);
            after->covariance[34] = after->covariance[34] + (p_4_8 * n_3);
            after->covariance[35] = after->covariance[35] + (p_5_8 * n_3);
            after->covariance[36] = after->covariance[36] + (p_6_8 * n_3);
            after->covariance[37] = after->covariance[37] + (p_7_8 * n_3);
            after->covariance[38] = n_3 * minus_r;
            after->covariance[39] = after->covariance[39] + (p_8_9 * n_3);
            after->covariance[40] = after->covariance[40] + (p_8_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_8_11 * n_3);
            const double n_4 = p_4_8 * minus_per_s;
            after->covariance[42] = after->covariance[42] + (p_4_8 * n_4);
            after->covariance[43] = after->covariance[43] + (p_5_8 * n_4);
            after->covariance[44] = after->covariance[44] + (p_6_8 * n_4);
            after->covariance[45] = after->covariance[45] + (p_7_8 * n_4);
            after->covariance[46] = n_4 * minus_r;
            after->covariance[47] = after->covariance[47] + (p_8_9 * n_4);
            after->covariance[48] = after->covariance[48] + (p_8_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_8_11 * n_4);
            const double n_5 = p_5_8 * minus_per_s;
            after->covariance[50] = after->covariance[50] + (p_5_8 * n_5);
            after->covariance[51] = after->covariance[51] + (p_6_8 * n_5);
            after->covariance[52] = after->covariance[52] + (p_7_8 * n_5);
            after->covariance[53] = n_5 * minus_r;
            after->covariance[54] = after->covariance[54] + (p_8_9 * n_5);
            after->covariance[55] = after->covariance[55] + (p_8_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_8_11 * n_5);
            const double n_6 = p_6_8 * minus_per_s;
            after->covariance[57] = after->covariance[57] + (p_6_8 * n_6);
            after->covariance[58] = after->covariance[58] + (p_7_8 * n_6);
            after->covariance[59] = n_6 * minus_r;
            after->covariance[60] = after->covariance[60] + (p_8_9 * n_6);
            after->covariance[61] = after->covariance[61] + (p_8_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_8_11 * n_6);
            const double n_7 = p_7_8 * minus_per_s;
            after->covariance[63] = after->covariance[63] + (p_7_8 * n_7);
            after->covariance[64] = n_7 * minus_r;
            after->covariance[65] = after->covariance[65] + (p_8_9 * n_7);
            after->covariance[66] = after->covariance[66] + (p_8_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_8_11 * n_7);
            const double n_8 = p_8_8 * minus_per_s;
            after->covariance[68] = n_8 * minus_r;
            const double n_9 = p_8_9 * minus_per_s;
            after->covariance[69] = n_9 * minus_r;
            const double n_10 = p_8_10 * minus_per_s;
            after->covariance[70] = n_10 * minus_r;
            const double n_11 = p_8_11 * minus_per_s;
            after->covariance[71] = n_11 * minus_r;
            after->covariance[72] = after->covariance[72] + (p_8_9 * n_9);
            after->covariance[73] = after->covariance[73] + (p_8_10 * n_9);
            after->covariance[74] = after->covariance[74] + (p_8_11 * n_9);
            after->covariance[75] = after->covariance[75] + (p_8_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_8_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_8_11 * n_11);
            const double delta_8 = delta[8];
            const double e = residual_8 - delta_8;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta_8 + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[8] = s;
        }

        /* row 9: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_9 = after->covariance[9];
            const double r_9 = params->variance_pose[9];
            const double p_9_9 = after->covariance[72];
            const double s = r_9 + p_9_9;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_9 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_9 * n_0);
            const double p_1_9 = after->covariance[20];
            after->covariance[1] = after->covariance[1] + (p_1_9 * n_0);
            const double p_2_9 = after->covariance[30];
            after->covariance[2] = after->covariance[2] + (p_2_9 * n_0);
            const double p_3_9 = after->covariance[39];
            after->covariance[3] = after->covariance[3] + (p_3_9 * n_0);
            const double p_4_9 = after->covariance[47];
            after->covariance[4] = after->covariance[4] + (p_4_9 * n_0);
            const double p_5_9 = after->covariance[54];
            after->covariance[5] = after->covariance[5] + (p_5_9 * n_0);
            const double p_6_9 = after->covariance[60];
            after->covariance[6] = after->covariance[6] + (p_6_9 * n_0);
            const double p_7_9 = after->covariance[65];
            after->covariance[7] = after->covariance[7] + (p_7_9 * n_0);
            const double p_8_9 = after->covariance[69];
            after->covariance[8] = after->covariance[8] + (p_8_9 * n_0);
            const double minus_r = -r_9;
            after->covariance[9] = n_0 * minus_r;
            const double p_9_10 = after->covariance[73];
            after->covariance[10] = after->covariance[10] + (p_9_10 * n_0);
            const double p_9_11 = after->covariance[74];
            after->covariance[11] = after->covariance[11] + (p_9_11 * n_0);
            const double n_1 = p_1_9 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_9 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_9 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_9 * n_1);
            after->covariance[15] = after->covariance[15] + (p_4_9 * n_1);
            after->covariance[16] = after->covariance[16] + (p_5_9 * n_1);
            after->covariance[17] = after->covariance[17] + (p_6_9 * n_1);
            after->covariance[18] = after->covariance[18] + (p_7_9 * n_1);
            after->covariance[19] = after->covariance[19] + (p_8_9 * n_1);
            after->covariance[20] = n_1 * minus_r;
            after->covariance[21] = after->covariance[21] + (p_9_10 * n_1);
            after->covariance[22] = after->covariance[22] + (p_9_11 * n_1);
            const double n_2 = p_2_9 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_9 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_9 * n_2);
            after->covariance[25] = after->covariance[25] + (p_4_9 * n_2);
            after->covariance[26] = after->covariance[26] + (p_5_9 * n_2);
            after->covariance[27] = after->covariance[27] + (p_6_9 * n_2);
            after->covariance[28] = after->covariance[28] + (p_7_9 * n_2);
            after->covariance[29] = after->covariance[29] + (p_8_9 * n_2);
            after->covariance[30] = n_2 * minus_r;
            after->covariance[31] = after->covariance[31] + (p_9_10 * n_2);
            after->covariance[32] = after->covariance[32] + (p_9_11 * n_2);
            const double n_3 = p_3_9 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_9 * n_3);
            after->covariance[34] = after->covariance[34] + (p_4_9 * n_3);
            after->covariance[35] = after->covariance[35] + (p_5_9 * n_3);
            after->covariance[36] = after->covariance[36] + (p_6_9 * n_3);
            after->covariance[37] = after->covariance[37] + (p_7_9 * n_3);
            after->covariance[38] = after->covariance[38] + (p_8_9 * n_3);
            after->covariance[39] = n_3 * minus_r;
            after->covariance[40] = after->covariance[40] + (p_9_10 * n_3);
            after->covariance[41] = after->covariance[41] + (p_9_11 * n_3);
            const double n_4 = p_4_9 * minus_per_s;
            after->covariance[42] = after->covariance[42] + (p_4_9 * n_4);
            after->covariance[43] = after->covariance[43] + (p_5_9 * n_4);
            after->covariance[44] = after->covariance[44] + (p_6_9 * n_4);
            after->covariance[45] = after->covariance[45] + (p_7_9 * n_4);
            after->covariance[46] = after->covariance[46] + (p_8_9 * n_4);
            after->covariance[47] = n_4 * minus_r;
            after->covariance[48] = after->covariance[48] + (p_9_10 * n_4);
            after->covariance[49] = after->covariance[49] + (p_9_11 * n_4);
            const double n_5 = p_5_9 * minus_per_s;
            after->covariance[50] = after->covariance[50] + (p_5_9 * n_5);
            after->covariance[51] = after->covariance[51] + (p_6_9 * n_5);
            after->covariance[52] = after->covariance[52] + (p_7_9 * n_5);
            after->covariance[53] = after->covariance[53] + (p_8_9 * n_5);
            after->covariance[54] = n_5 * minus_r;
            after->covariance[55] = after->covariance[55] + (p_9_10 * n_5);
            after->covariance[56] = after->covariance[56] + (p_9_11 * n_5);
            const double n_6 = p_6_9 * minus_per_s;
            after->covariance[57] = after->covariance[57] + (p_6_9 * n_6);
            after->covariance[58] = after->covariance[58] + (p_7_9 * n_6);
            after->covariance[59] = after->covariance[59] + (p_8_9 * n_6);
            after->covariance[60] = n_6 * minus_r;
            after->covariance[61] = after->covariance[61] + (p_9_10 * n_6);
            after->covariance[62] = after->covariance[62] + (p_9_11 * n_6);
            const double n_7 = p_7_9 * minus_per_s;
            after->covariance[63] = after->covariance[63] + (p_7_9 * n_7);
            after->covariance[64] = after->covariance[64] + (p_8_9 * n_7);
            after->covariance[65] = n_7 * minus_r;
            after->covariance[66] = after->covariance[66] + (p_9_10 * n_7);
            after->covariance[67] = after->covariance[67] + (p_9_11 * n_7);
            const double n_8 = p_8_9 * minus_per_s;
            after->covariance[68] = after->covariance[68] + (p_8_9 * n_8);
            after->covariance[69] = n_8 * minus_r;
            after->covariance[70] = after->covariance[70] + (p_9_10 * n_8);
            after->covariance[71] = after->covariance[71] + (p_9_11 * n_8);
            const double n_9 = p_9_9 * minus_per_s;
            after->covariance[72] = n_9 * minus_r;
            const double n_10 = p_9_10 * minus_per_s;
            after->covariance[73] = n_10 * minus_r;
            const double n_11 = p_9_11 * minus_per_s;
            after->covariance[74] = n_11 * minus_r;
            after->covariance[75] = after->covariance[75] + (p_9_10 * n_10);
            after->covariance[76] = after->covariance[76] + (p_9_11 * n_10);
            after->covariance[77] = after->covariance[77] + (p_9_11 * n_11);
            const double delta_9 = delta[9];
            const double e = residual_9 - delta_9;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta_9 + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[9] = s;
        }

        /* row 10: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_10 = after->covariance[10];
            const double r_10 = params->variance_pose[10];
            const double p_10_10 = after->covariance[75];
            const double s = r_10 + p_10_10;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_10 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_10 * n_0);
            const double p_1_10 = after->covariance[21];
            after->covariance[1] = after->covariance[1] + (p_1_10 * n_0);
            const double p_2_10 = after->covariance[31];
            after->covariance[2] = after->covariance[2] + (p_2_10 * n_0);
            const double p_3_10 = after->covariance[40];
            after->covariance[3] = after->covariance[3] + (p_3_10 * n_0);
            const double p_4_10 = after->covariance[48];
            after->covariance[4] = after->covariance[4] + (p_4_10 * n_0);
            const double p_5_10 = after->covariance[55];
            after->covariance[5] = after->covariance[5] + (p_5_10 * n_0);
            const double p_6_10 = after->covariance[61];
            after->covariance[6] = after->covariance[6] + (p_6_10 * n_0);
            const double p_7_10 = after->covariance[66];
            after->covariance[7] = after->covariance[7] + (p_7_10 * n_0);
            const double p_8_10 = after->covariance[70];
            after->covariance[8] = after->covariance[8] + (p_8_10 * n_0);
            const double p_9_10 = after->covariance[73];
            after->covariance[9] = after->covariance[9] + (p_9_10 * n_0);
            const double minus_r = -r_10;
            after->covariance[10] = n_0 * minus_r;
            const double p_10_11 = after->covariance[76];
            after->covariance[11] = after->covariance[11] + (p_10_11 * n_0);
            const double n_1 = p_1_10 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_10 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_10 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_10 * n_1);
            after->covariance[15] = after->covariance[15] + (p_4_10 * n_1);
            after->covariance[16] = after->covariance[16] + (p_5_10 * n_1);
            after->covariance[17] = after->covariance[17] + (p_6_10 * n_1);
            after->covariance[18] = after->covariance[18] + (p_7_10 * n_1);
            after->covariance[19] = after->covariance[19] + (p_8_10 * n_1);
            after->covariance[20] = after->covariance[20] + (p_9_10 * n_1);
            after->covariance[21] = n_1 * minus_r;
            after->covariance[22] = after->covariance[22] + (p_10_11 * n_1);
            const double n_2 = p_2_10 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_10 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_10 * n_2);
            after->covariance[25] = after->covariance[25] + (p_4_10 * n_2);
            after->covariance[26] = after->covariance[26] + (p_5_10 * n_2);
            after->covariance[27] = after->covariance[27] + (p_6_10 * n_2);
            after->covariance[28] = after->covariance[28] + (p_7_10 * n_2);
            after->covariance[29] = after->covariance[29] + (p_8_10 * n_2);
            after->covariance[30] = after->covariance[30] + (p_9_10 * n_2);
            after->covariance[31] = n_2 * minus_r;
            after->covariance[32] = after->covariance[32] + (p_10_11 * n_2);
            const double n_3 = p_3_10 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_10 * n_3);
            after->covariance[34] = after->covariance[34] + (p_4_10 * n_3);
            after->covariance[35] = after->covariance[35] + (p_5_10 * n_3);
            after->covariance[36] = after->covariance[36] + (p_6_10 * n_3);
            after->covariance[37] = after->covariance[37] + (p_7_10 * n_3);
            after->covariance[38] = after->covariance[38] + (p_8_10 * n_3);
            after->covariance[39] = after->covariance[39] + (p_9_10 * n_3);
            after->covariance[40] = n_3 * minus_r;
            after->covariance[41] = after->covariance[41] + (p_10_11 * n_3);
            const double n_4 = p_4_10 * minus_per_s;
            after->covariance[42] = after->covariance[42] + (p_4_10 * n_4);
            after->covariance[43] = after->covariance[43] + (p_5_10 * n_4);
            after->covariance[44] = after->covariance[44] + (p_6_10 * n_4);
            after->covariance[45] = after->covariance[45] + (p_7_10 * n_4);
            after->covariance[46] = after->covariance[46] + (p_8_10 * n_4);
            after->covariance[47] = after->covariance[47] + (p_9_10 * n_4);
            after->covariance[48] = n_4 * minus_r;
            after->covariance[49] = after->covariance[49] + (p_10_11 * n_4);
            const double n_5 = p_5_10 * minus_per_s;
            after->covariance[50] = after->covariance[50] + (p_5_10 * n_5);
            after->covariance[51] = after->covariance[51] + (p_6_10 * n_5);
            after->covariance[52] = after->covariance[52] + (p_7_10 * n_5);
            after->covariance[53] = after->covariance[53] + (p_8_10 * n_5);
            after->covariance[54] = after->covariance[54] + (p_9_10 * n_5);
            after->covariance[55] = n_5 * minus_r;
            after->covariance[56] = after->covariance[56] + (p_10_11 * n_5);
            const double n_6 = p_6_10 * minus_per_s;
            after->covariance[57] = after->covariance[57] + (p_6_10 * n_6);
            after->covariance[58] = after->covariance[58] + (p_7_10 * n_6);
            after->covariance[59] = after->covariance[59] + (p_8_10 * n_6);
            after->covariance[60] = after->covariance[60] + (p_9_10 * n_6);
            after->covariance[61] = n_6 * minus_r;
            after->covariance[62] = after->covariance[62] + (p_10_11 * n_6);
            const double n_7 = p_7_10 * minus_per_s;
            after->covariance[63] = after->covariance[63] + (p_7_10 * n_7);
            after->covariance[64] = after->covariance[64] + (p_8_10 * n_7);
            after->covariance[65] = after->covariance[65] + (p_9_10 * n_7);
            after->covariance[66] = n_7 * minus_r;
            after->covariance[67] = after->covariance[67] + (p_10_11 * n_7);
            const double n_8 = p_8_10 * minus_per_s;
            after->covariance[68] = after->covariance[68] + (p_8_10 * n_8);
            after->covariance[69] = after->covariance[69] + (p_9_10 * n_8);
            after->covariance[70] = n_8 * minus_r;
            after->covariance[71] = after->covariance[71] + (p_10_11 * n_8);
            const double n_9 = p_9_10 * minus_per_s;
            after->covariance[72] = after->covariance[72] + (p_9_10 * n_9);
            after->covariance[73] = n_9 * minus_r;
            after->covariance[74] = after->covariance[74] + (p_10_11 * n_9);
            const double n_10 = p_10_10 * minus_per_s;
            after->covariance[75] = n_10 * minus_r;
            const double n_11 = p_10_11 * minus_per_s;
            after->covariance[76] = n_11 * minus_r;
            after->covariance[77] = after->covariance[77] + (p_10_11 * n_11);
            const double delta_10 = delta[10];
            const double e = residual_10 - delta_10;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta_10 + (n_10 * minus_e);
            delta[11] = delta[11] + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[10] = s;
        }

        /* row 11: d = d + K e, P = P - K s K'; the measured row as r K */
        {
            const double p_0_11 = after->covariance[11];
            const double r_11 = params->variance_pose[11];
            const double p_11_11 = after->covariance[77];
            const double s = r_11 + p_11_11;
            const double per_s = 1.0 / ((s >= 1.0e-20) ? s : 1.0);
            const double minus_per_s = -per_s;
            const double n_0 = p_0_11 * minus_per_s;
            after->covariance[0] = after->covariance[0] + (p_0_11 * n_0);
            const double p_1_11 = after->covariance[22];
            after->covariance[1] = after->covariance[1] + (p_1_11 * n_0);
            const double p_2_11 = after->covariance[32];
            after->covariance[2] = after->covariance[2] + (p_2_11 * n_0);
            const double p_3_11 = after->covariance[41];
            after->covariance[3] = after->covariance[3] + (p_3_11 * n_0);
            const double p_4_11 = after->covariance[49];
            after->covariance[4] = after->covariance[4] + (p_4_11 * n_0);
            const double p_5_11 = after->covariance[56];
            after->covariance[5] = after->covariance[5] + (p_5_11 * n_0);
            const double p_6_11 = after->covariance[62];
            after->covariance[6] = after->covariance[6] + (p_6_11 * n_0);
            const double p_7_11 = after->covariance[67];
            after->covariance[7] = after->covariance[7] + (p_7_11 * n_0);
            const double p_8_11 = after->covariance[71];
            after->covariance[8] = after->covariance[8] + (p_8_11 * n_0);
            const double p_9_11 = after->covariance[74];
            after->covariance[9] = after->covariance[9] + (p_9_11 * n_0);
            const double p_10_11 = after->covariance[76];
            after->covariance[10] = after->covariance[10] + (p_10_11 * n_0);
            const double minus_r = -r_11;
            after->covariance[11] = n_0 * minus_r;
            const double n_1 = p_1_11 * minus_per_s;
            after->covariance[12] = after->covariance[12] + (p_1_11 * n_1);
            after->covariance[13] = after->covariance[13] + (p_2_11 * n_1);
            after->covariance[14] = after->covariance[14] + (p_3_11 * n_1);
            after->covariance[15] = after->covariance[15] + (p_4_11 * n_1);
            after->covariance[16] = after->covariance[16] + (p_5_11 * n_1);
            after->covariance[17] = after->covariance[17] + (p_6_11 * n_1);
            after->covariance[18] = after->covariance[18] + (p_7_11 * n_1);
            after->covariance[19] = after->covariance[19] + (p_8_11 * n_1);
            after->covariance[20] = after->covariance[20] + (p_9_11 * n_1);
            after->covariance[21] = after->covariance[21] + (p_10_11 * n_1);
            after->covariance[22] = n_1 * minus_r;
            const double n_2 = p_2_11 * minus_per_s;
            after->covariance[23] = after->covariance[23] + (p_2_11 * n_2);
            after->covariance[24] = after->covariance[24] + (p_3_11 * n_2);
            after->covariance[25] = after->covariance[25] + (p_4_11 * n_2);
            after->covariance[26] = after->covariance[26] + (p_5_11 * n_2);
            after->covariance[27] = after->covariance[27] + (p_6_11 * n_2);
            after->covariance[28] = after->covariance[28] + (p_7_11 * n_2);
            after->covariance[29] = after->covariance[29] + (p_8_11 * n_2);
            after->covariance[30] = after->covariance[30] + (p_9_11 * n_2);
            after->covariance[31] = after->covariance[31] + (p_10_11 * n_2);
            after->covariance[32] = n_2 * minus_r;
            const double n_3 = p_3_11 * minus_per_s;
            after->covariance[33] = after->covariance[33] + (p_3_11 * n_3);
            after->covariance[34] = after->covariance[34] + (p_4_11 * n_3);
            after->covariance[35] = after->covariance[35] + (p_5_11 * n_3);
            after->covariance[36] = after->covariance[36] + (p_6_11 * n_3);
            after->covariance[37] = after->covariance[37] + (p_7_11 * n_3);
            after->covariance[38] = after->covariance[38] + (p_8_11 * n_3);
            after->covariance[39] = after->covariance[39] + (p_9_11 * n_3);
            after->covariance[40] = after->covariance[40] + (p_10_11 * n_3);
            after->covariance[41] = n_3 * minus_r;
            const double n_4 = p_4_11 * minus_per_s;
            after->covariance[42] = after->covariance[42] + (p_4_11 * n_4);
            after->covariance[43] = after->covariance[43] + (p_5_11 * n_4);
            after->covariance[44] = after->covariance[44] + (p_6_11 * n_4);
            after->covariance[45] = after->covariance[45] + (p_7_11 * n_4);
            after->covariance[46] = after->covariance[46] + (p_8_11 * n_4);
            after->covariance[47] = after->covariance[47] + (p_9_11 * n_4);
            after->covariance[48] = after->covariance[48] + (p_10_11 * n_4);
            after->covariance[49] = n_4 * minus_r;
            const double n_5 = p_5_11 * minus_per_s;
            after->covariance[50] = after->covariance[50] + (p_5_11 * n_5);
            after->covariance[51] = after->covariance[51] + (p_6_11 * n_5);
            after->covariance[52] = after->covariance[52] + (p_7_11 * n_5);
            after->covariance[53] = after->covariance[53] + (p_8_11 * n_5);
            after->covariance[54] = after->covariance[54] + (p_9_11 * n_5);
            after->covariance[55] = after->covariance[55] + (p_10_11 * n_5);
            after->covariance[56] = n_5 * minus_r;
            const double n_6 = p_6_11 * minus_per_s;
            after->covariance[57] = after->covariance[57] + (p_6_11 * n_6);
            after->covariance[58] = after->covariance[58] + (p_7_11 * n_6);
            after->covariance[59] = after->covariance[59] + (p_8_11 * n_6);
            after->covariance[60] = after->covariance[60] + (p_9_11 * n_6);
            after->covariance[61] = after->covariance[61] + (p_10_11 * n_6);
            after->covariance[62] = n_6 * minus_r;
            const double n_7 = p_7_11 * minus_per_s;
            after->covariance[63] = after->covariance[63] + (p_7_11 * n_7);
            after->covariance[64] = after->covariance[64] + (p_8_11 * n_7);
            after->covariance[65] = after->covariance[65] + (p_9_11 * n_7);
            after->covariance[66] = after->covariance[66] + (p_10_11 * n_7);
            after->covariance[67] = n_7 * minus_r;
            const double n_8 = p_8_11 * minus_per_s;
            after->covariance[68] = after->covariance[68] + (p_8_11 * n_8);
            after->covariance[69] = after->covariance[69] + (p_9_11 * n_8);
            after->covariance[70] = after->covariance[70] + (p_10_11 * n_8);
            after->covariance[71] = n_8 * minus_r;
            const double n_9 = p_9_11 * minus_per_s;
            after->covariance[72] = after->covariance[72] + (p_9_11 * n_9);
            after->covariance[73] = after->covariance[73] + (p_10_11 * n_9);
            after->covariance[74] = n_9 * minus_r;
            const double n_10 = p_10_11 * minus_per_s;
            after->covariance[75] = after->covariance[75] + (p_10_11 * n_10);
            after->covariance[76] = n_10 * minus_r;
            const double n_11 = p_11_11 * minus_per_s;
            after->covariance[77] = n_11 * minus_r;
            const double delta_11 = delta[11];
            const double e = residual_11 - delta_11;
            const double minus_e = -e;
            delta[0] = delta[0] + (n_0 * minus_e);
            delta[1] = delta[1] + (n_1 * minus_e);
            delta[2] = delta[2] + (n_2 * minus_e);
            delta[3] = delta[3] + (n_3 * minus_e);
            delta[4] = delta[4] + (n_4 * minus_e);
            delta[5] = delta[5] + (n_5 * minus_e);
            delta[6] = delta[6] + (n_6 * minus_e);
            delta[7] = delta[7] + (n_7 * minus_e);
            delta[8] = delta[8] + (n_8 * minus_e);
            delta[9] = delta[9] + (n_9 * minus_e);
            delta[10] = delta[10] + (n_10 * minus_e);
            delta[11] = delta_11 + (n_11 * minus_e);
            nis[0] = nis[0] + (e * (per_s * e));
            row_variance[11] = s;
        }

        if (!((row_variance[0] >= 1.0e-20) && (row_variance[1] >= 1.0e-20) && (row_variance[2] >= 1.0e-20)
              && (row_variance[3] >= 1.0e-20) && (row_variance[4] >= 1.0e-20) && (row_variance[5] >= 1.0e-20)
              && (row_variance[6] >= 1.0e-20) && (row_variance[7] >= 1.0e-20) && (row_variance[8] >= 1.0e-20)
              && (row_variance[9] >= 1.0e-20) && (row_variance[10] >= 1.0e-20) && (row_variance[11] >= 1.0e-20)))
        {
            status = QUADROTOR_KF_NOT_POSITIVE;
        }
        else
        {
            out->nis = nis[0];

            /* accepted? */
            if ((gate <= 0.0) || (nis[0] <= gate))
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
                if (!((after->covariance[0] >= 1.0e-20) && (after->covariance[0] <= 1.0e9)
                      && (after->covariance[12] >= 1.0e-20) && (after->covariance[12] <= 1.0e9)
                      && (after->covariance[23] >= 1.0e-20) && (after->covariance[23] <= 1.0e9)
                      && (after->covariance[33] >= 1.0e-20) && (after->covariance[33] <= 1.0e9)
                      && (after->covariance[42] >= 1.0e-20) && (after->covariance[42] <= 1.0e9)
                      && (after->covariance[50] >= 1.0e-20) && (after->covariance[50] <= 1.0e9)
                      && (after->covariance[57] >= 1.0e-20) && (after->covariance[57] <= 1.0e9)
                      && (after->covariance[63] >= 1.0e-20) && (after->covariance[63] <= 1.0e9)
                      && (after->covariance[68] >= 1.0e-20) && (after->covariance[68] <= 1.0e9)
                      && (after->covariance[72] >= 1.0e-20) && (after->covariance[72] <= 1.0e9)
                      && (after->covariance[75] >= 1.0e-20) && (after->covariance[75] <= 1.0e9)
                      && (after->covariance[77] >= 1.0e-20) && (after->covariance[77] <= 1.0e9)))
                {
                    status = quadrotor_kf_hold_variances(after->covariance);
                }
                if (status >= QUADROTOR_KF_OK)
                {
                    if (!((fabs(after->x) <= 10000.0) && (fabs(after->vx) <= 1000.0) && (fabs(after->y) <= 10000.0)
                          && (fabs(after->vy) <= 1000.0) && (fabs(after->z) <= 10000.0) && (fabs(after->vz) <= 1000.0)
                          && (fabs(after->roll) <= 30.0) && (fabs(after->roll_rate) <= 100.0)
                          && (fabs(after->pitch) <= 30.0) && (fabs(after->pitch_rate) <= 100.0)
                          && (fabs(after->yaw) <= 30.0) && (fabs(after->yaw_rate) <= 100.0)
                          && (fabs(after->covariance[1]) <= 1.0e9) && (fabs(after->covariance[2]) <= 1.0e9)
                          && (fabs(after->covariance[3]) <= 1.0e9) && (fabs(after->covariance[4]) <= 1.0e9)
                          && (fabs(after->covariance[5]) <= 1.0e9) && (fabs(after->covariance[6]) <= 1.0e9)
                          && (fabs(after->covariance[7]) <= 1.0e9) && (fabs(after->covariance[8]) <= 1.0e9)
                          && (fabs(after->covariance[9]) <= 1.0e9) && (fabs(after->covariance[10]) <= 1.0e9)
                          && (fabs(after->covariance[11]) <= 1.0e9) && (fabs(after->covariance[13]) <= 1.0e9)
                          && (fabs(after->covariance[14]) <= 1.0e9) && (fabs(after->covariance[15]) <= 1.0e9)
                          && (fabs(after->covariance[16]) <= 1.0e9) && (fabs(after->covariance[17]) <= 1.0e9)
                          && (fabs(after->covariance[18]) <= 1.0e9) && (fabs(after->covariance[19]) <= 1.0e9)
                          && (fabs(after->covariance[20]) <= 1.0e9) && (fabs(after->covariance[21]) <= 1.0e9)
                          && (fabs(after->covariance[22]) <= 1.0e9) && (fabs(after->covariance[24]) <= 1.0e9)
                          && (fabs(after->covariance[25]) <= 1.0e9) && (fabs(after->covariance[26]) <= 1.0e9)
                          && (fabs(after->covariance[27]) <= 1.0e9) && (fabs(after->covariance[28]) <= 1.0e9)
                          && (fabs(after->covariance[29]) <= 1.0e9) && (fabs(after->covariance[30]) <= 1.0e9)
                          && (fabs(after->covariance[31]) <= 1.0e9) && (fabs(after->covariance[32]) <= 1.0e9)
                          && (fabs(after->covariance[34]) <= 1.0e9) && (fabs(after->covariance[35]) <= 1.0e9)
                          && (fabs(after->covariance[36]) <= 1.0e9) && (fabs(after->covariance[37]) <= 1.0e9)
                          && (fabs(after->covariance[38]) <= 1.0e9) && (fabs(after->covariance[39]) <= 1.0e9)
                          && (fabs(after->covariance[40]) <= 1.0e9) && (fabs(after->covariance[41]) <= 1.0e9)
                          && (fabs(after->covariance[43]) <= 1.0e9) && (fabs(after->covariance[44]) <= 1.0e9)
                          && (fabs(after->covariance[45]) <= 1.0e9) && (fabs(after->covariance[46]) <= 1.0e9)
                          && (fabs(after->covariance[47]) <= 1.0e9) && (fabs(after->covariance[48]) <= 1.0e9)
                          && (fabs(after->covariance[49]) <= 1.0e9) && (fabs(after->covariance[51]) <= 1.0e9)
                          && (fabs(after->covariance[52]) <= 1.0e9) && (fabs(after->covariance[53]) <= 1.0e9)
                          && (fabs(after->covariance[54]) <= 1.0e9) && (fabs(after->covariance[55]) <= 1.0e9)
                          && (fabs(after->covariance[56]) <= 1.0e9) && (fabs(after->covariance[58]) <= 1.0e9)
                          && (fabs(after->covariance[59]) <= 1.0e9) && (fabs(after->covariance[60]) <= 1.0e9)
                          && (fabs(after->covariance[61]) <= 1.0e9) && (fabs(after->covariance[62]) <= 1.0e9)
                          && (fabs(after->covariance[64]) <= 1.0e9) && (fabs(after->covariance[65]) <= 1.0e9)
                          && (fabs(after->covariance[66]) <= 1.0e9) && (fabs(after->covariance[67]) <= 1.0e9)
                          && (fabs(after->covariance[69]) <= 1.0e9) && (fabs(after->covariance[70]) <= 1.0e9)
                          && (fabs(after->covariance[71]) <= 1.0e9) && (fabs(after->covariance[73]) <= 1.0e9)
                          && (fabs(after->covariance[74]) <= 1.0e9) && (fabs(after->covariance[76]) <= 1.0e9)))
                    {
                        status = QUADROTOR_KF_OVERFLOW;
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
                status = quadrotor_kf_higher(status, QUADROTOR_KF_GATED);
            }
        }
    }
    return status;
}

/* 78 multiplications. */
static quadrotor_kf_status_t quadrotor_kf_inflate_core(const quadrotor_kf_state_t *before, quadrotor_kf_state_t *after,
                                                       const double factor)
{
    quadrotor_kf_status_t status = QUADROTOR_KF_OK;

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

    if (!((factor >= 1.0) && (factor <= 1000000.0)))
    {
        status = QUADROTOR_KF_BAD_INPUT;
    }
    else
    {
        /* P = factor P */
        {
            after->covariance[0] = factor * before->covariance[0];
            after->covariance[1] = factor * before->covariance[1];
            after->covariance[2] = factor * before->covariance[2];
            after->covariance[3] = factor * before->covariance[3];
            after->covariance[4] = factor * before->covariance[4];
            after->covariance[5] = factor * before->covariance[5];
            after->covariance[6] = factor * before->covariance[6];
            after->covariance[7] = factor * before->covariance[7];
            after->covariance[8] = factor * before->covariance[8];
            after->covariance[9] = factor * before->covariance[9];
            after->covariance[10] = factor * before->covariance[10];
            after->covariance[11] = factor * before->covariance[11];
            after->covariance[12] = factor * before->covariance[12];
            after->covariance[13] = factor * before->covariance[13];
            after->covariance[14] = factor * before->covariance[14];
            after->covariance[15] = factor * before->covariance[15];
            after->covariance[16] = factor * before->covariance[16];
            after->covariance[17] = factor * before->covariance[17];
            after->covariance[18] = factor * before->covariance[18];
            after->covariance[19] = factor * before->covariance[19];
            after->covariance[20] = factor * before->covariance[20];
            after->covariance[21] = factor * before->covariance[21];
            after->covariance[22] = factor * before->covariance[22];
            after->covariance[23] = factor * before->covariance[23];
            after->covariance[24] = factor * before->covariance[24];
            after->covariance[25] = factor * before->covariance[25];
            after->covariance[26] = factor * before->covariance[26];
            after->covariance[27] = factor * before->covariance[27];
            after->covariance[28] = factor * before->covariance[28];
            after->covariance[29] = factor * before->covariance[29];
            after->covariance[30] = factor * before->covariance[30];
            after->covariance[31] = factor * before->covariance[31];
            after->covariance[32] = factor * before->covariance[32];
            after->covariance[33] = factor * before->covariance[33];
            after->covariance[34] = factor * before->covariance[34];
            after->covariance[35] = factor * before->covariance[35];
            after->covariance[36] = factor * before->covariance[36];
            after->covariance[37] = factor * before->covariance[37];
            after->covariance[38] = factor * before->covariance[38];
            after->covariance[39] = factor * before->covariance[39];
            after->covariance[40] = factor * before->covariance[40];
            after->covariance[41] = factor * before->covariance[41];
            after->covariance[42] = factor * before->covariance[42];
            after->covariance[43] = factor * before->covariance[43];
            after->covariance[44] = factor * before->covariance[44];
            after->covariance[45] = factor * before->covariance[45];
            after->covariance[46] = factor * before->covariance[46];
            after->covariance[47] = factor * before->covariance[47];
            after->covariance[48] = factor * before->covariance[48];
            after->covariance[49] = factor * before->covariance[49];
            after->covariance[50] = factor * before->covariance[50];
            after->covariance[51] = factor * before->covariance[51];
            after->covariance[52] = factor * before->covariance[52];
            after->covariance[53] = factor * before->covariance[53];
            after->covariance[54] = factor * before->covariance[54];
            after->covariance[55] = factor * before->covariance[55];
            after->covariance[56] = factor * before->covariance[56];
            after->covariance[57] = factor * before->covariance[57];
            after->covariance[58] = factor * before->covariance[58];
            after->covariance[59] = factor * before->covariance[59];
            after->covariance[60] = factor * before->covariance[60];
            after->covariance[61] = factor * before->covariance[61];
            after->covariance[62] = factor * before->covariance[62];
            after->covariance[63] = factor * before->covariance[63];
            after->covariance[64] = factor * before->covariance[64];
            after->covariance[65] = factor * before->covariance[65];
            after->covariance[66] = factor * before->covariance[66];
            after->covariance[67] = factor * before->covariance[67];
            after->covariance[68] = factor * before->covariance[68];
            after->covariance[69] = factor * before->covariance[69];
            after->covariance[70] = factor * before->covariance[70];
            after->covariance[71] = factor * before->covariance[71];
            after->covariance[72] = factor * before->covariance[72];
            after->covariance[73] = factor * before->covariance[73];
            after->covariance[74] = factor * before->covariance[74];
            after->covariance[75] = factor * before->covariance[75];
            after->covariance[76] = factor * before->covariance[76];
            after->covariance[77] = factor * before->covariance[77];
        }

        /* judge, then commit */
        if (!((after->covariance[0] >= 1.0e-20) && (after->covariance[0] <= 1.0e9) && (after->covariance[12] >= 1.0e-20)
              && (after->covariance[12] <= 1.0e9) && (after->covariance[23] >= 1.0e-20)
              && (after->covariance[23] <= 1.0e9) && (after->covariance[33] >= 1.0e-20)
              && (after->covariance[33] <= 1.0e9) && (after->covariance[42] >= 1.0e-20)
              && (after->covariance[42] <= 1.0e9) && (after->covariance[50] >= 1.0e-20)
              && (after->covariance[50] <= 1.0e9) && (after->covariance[57] >= 1.0e-20)
              && (after->covariance[57] <= 1.0e9) && (after->covariance[63] >= 1.0e-20)
              && (after->covariance[63] <= 1.0e9) && (after->covariance[68] >= 1.0e-20)
              && (after->covariance[68] <= 1.0e9) && (after->covariance[72] >= 1.0e-20)
              && (after->covariance[72] <= 1.0e9) && (after->covariance[75] >= 1.0e-20)
              && (after->covariance[75] <= 1.0e9) && (after->covariance[77] >= 1.0e-20)
              && (after->covariance[77] <= 1.0e9)))
        {
            status = quadrotor_kf_hold_variances(after->covariance);
        }
        if (status >= QUADROTOR_KF_OK)
        {
            if (!((fabs(after->covariance[1]) <= 1.0e9) && (fabs(after->covariance[2]) <= 1.0e9)
                  && (fabs(after->covariance[3]) <= 1.0e9) && (fabs(after->covariance[4]) <= 1.0e9)
                  && (fabs(after->covariance[5]) <= 1.0e9) && (fabs(after->covariance[6]) <= 1.0e9)
                  && (fabs(after->covariance[7]) <= 1.0e9) && (fabs(after->covariance[8]) <= 1.0e9)
                  && (fabs(after->covariance[9]) <= 1.0e9) && (fabs(after->covariance[10]) <= 1.0e9)
                  && (fabs(after->covariance[11]) <= 1.0e9) && (fabs(after->covariance[13]) <= 1.0e9)
                  && (fabs(after->covariance[14]) <= 1.0e9) && (fabs(after->covariance[15]) <= 1.0e9)
                  && (fabs(after->covariance[16]) <= 1.0e9) && (fabs(after->covariance[17]) <= 1.0e9)
                  && (fabs(after->covariance[18]) <= 1.0e9) && (fabs(after->covariance[19]) <= 1.0e9)
                  && (fabs(after->covariance[20]) <= 1.0e9) && (fabs(after->covariance[21]) <= 1.0e9)
                  && (fabs(after->covariance[22]) <= 1.0e9) && (fabs(after->covariance[24]) <= 1.0e9)
                  && (fabs(after->covariance[25]) <= 1.0e9) && (fabs(after->covariance[26]) <= 1.0e9)
                  && (fabs(after->covariance[27]) <= 1.0e9) && (fabs(after->covariance[28]) <= 1.0e9)
                  && (fabs(after->covariance[29]) <= 1.0e9) && (fabs(after->covariance[30]) <= 1.0e9)
                  && (fabs(after->covariance[31]) <= 1.0e9) && (fabs(after->covariance[32]) <= 1.0e9)
                  && (fabs(after->covariance[34]) <= 1.0e9) && (fabs(after->covariance[35]) <= 1.0e9)
                  && (fabs(after->covariance[36]) <= 1.0e9) && (fabs(after->covariance[37]) <= 1.0e9)
                  && (fabs(after->covariance[38]) <= 1.0e9) && (fabs(after->covariance[39]) <= 1.0e9)
                  && (fabs(after->covariance[40]) <= 1.0e9) && (fabs(after->covariance[41]) <= 1.0e9)
                  && (fabs(after->covariance[43]) <= 1.0e9) && (fabs(after->covariance[44]) <= 1.0e9)
                  && (fabs(after->covariance[45]) <= 1.0e9) && (fabs(after->covariance[46]) <= 1.0e9)
                  && (fabs(after->covariance[47]) <= 1.0e9) && (fabs(after->covariance[48]) <= 1.0e9)
                  && (fabs(after->covariance[49]) <= 1.0e9) && (fabs(after->covariance[51]) <= 1.0e9)
                  && (fabs(after->covariance[52]) <= 1.0e9) && (fabs(after->covariance[53]) <= 1.0e9)
                  && (fabs(after->covariance[54]) <= 1.0e9) && (fabs(after->covariance[55]) <= 1.0e9)
                  && (fabs(after->covariance[56]) <= 1.0e9) && (fabs(after->covariance[58]) <= 1.0e9)
                  && (fabs(after->covariance[59]) <= 1.0e9) && (fabs(after->covariance[60]) <= 1.0e9)
                  && (fabs(after->covariance[61]) <= 1.0e9) && (fabs(after->covariance[62]) <= 1.0e9)
                  && (fabs(after->covariance[64]) <= 1.0e9) && (fabs(after->covariance[65]) <= 1.0e9)
                  && (fabs(after->covariance[66]) <= 1.0e9) && (fabs(after->covariance[67]) <= 1.0e9)
                  && (fabs(after->covariance[69]) <= 1.0e9) && (fabs(after->covariance[70]) <= 1.0e9)
                  && (fabs(after->covariance[71]) <= 1.0e9) && (fabs(after->covariance[73]) <= 1.0e9)
                  && (fabs(after->covariance[74]) <= 1.0e9) && (fabs(after->covariance[76]) <= 1.0e9)))
            {
                status = QUADROTOR_KF_OVERFLOW;
            }
        }
    }
    return status;
}

static quadrotor_kf_status_t quadrotor_kf_step_core(const quadrotor_kf_state_t *before, quadrotor_kf_state_t *after,
                                                    const quadrotor_kf_params_t *params, const double rotor_1,
                                                    const double rotor_2, const double rotor_3, const double rotor_4,
                                                    const bool has_pose, const double pose[12],
                                                    quadrotor_kf_step_out_t *out)
{
    quadrotor_kf_state_t work[3];
    quadrotor_kf_state_t *latest = &work[0];
    quadrotor_kf_state_t *spare = &work[1];
    quadrotor_kf_status_t status = quadrotor_kf_predict_core(before, latest, params, rotor_1, rotor_2, rotor_3,
        rotor_4);

    if (status >= QUADROTOR_KF_OK)
    {
        /* pose */
        if (has_pose)
        {
            /* pose gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_pose >= params->reject_limit))
            {
                quadrotor_kf_status_t own = quadrotor_kf_inflate_core(latest, &work[2], params->inflation);
                quadrotor_kf_status_t highest = status;

                if (own >= QUADROTOR_KF_OK)
                {
                    highest = quadrotor_kf_higher(highest, own);
                    own = quadrotor_kf_update_pose_core(&work[2], spare, params, pose, 0.0, &out->pose);
                }
                out->status_pose = own;
                if (own >= QUADROTOR_KF_OK)
                {
                    quadrotor_kf_state_t *const taken = spare;

                    spare = latest;
                    latest = taken;
                    status = quadrotor_kf_higher(highest, own);
                    status = quadrotor_kf_higher(status, QUADROTOR_KF_RECOVERED);
                }
                else
                {
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                    out->pose.innovation[i] = 0.0;
                    }
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                    out->pose.variance[i] = 0.0;
                    }
                    out->pose.nis = 0.0;
                    status = quadrotor_kf_higher(status, QUADROTOR_KF_SKIPPED);
                }
            }
            else
            {
                quadrotor_kf_status_t own = quadrotor_kf_update_pose_core(latest, spare, params, pose,
                    params->gate_pose, &out->pose);

                out->status_pose = own;
                if (own >= QUADROTOR_KF_OK)
                {
                    quadrotor_kf_state_t *const taken = spare;

                    spare = latest;
                    latest = taken;
                    status = quadrotor_kf_higher(status, own);
                }
                else
                {
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                    out->pose.innovation[i] = 0.0;
                    }
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                    out->pose.variance[i] = 0.0;
                    }
                    out->pose.nis = 0.0;
                    status = quadrotor_kf_higher(status, QUADROTOR_KF_SKIPPED);
                }
            }
        }
        else
        {
            for (uint32_t i = 0U; i < 12U; i++)
            {
            out->pose.innovation[i] = 0.0;
            }
            for (uint32_t i = 0U; i < 12U; i++)
            {
            out->pose.variance[i] = 0.0;
            }
            out->pose.nis = 0.0;
            out->status_pose = QUADROTOR_KF_OK;
        }
        *after = *latest;
    }
    return status;
}

quadrotor_kf_status_t quadrotor_kf_init(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params)
{
    quadrotor_kf_state_t after;
    const quadrotor_kf_status_t status = quadrotor_kf_init_core(&after, params);

    if (status >= QUADROTOR_KF_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_kf_status_t quadrotor_kf_predict(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                           const quadrotor_kf_predict_in_t *in)
{
    quadrotor_kf_state_t after;
    const quadrotor_kf_status_t status = quadrotor_kf_predict_core(state, &after, params, in->rotor_1, in->rotor_2,
        in->rotor_3, in->rotor_4);

    if (status >= QUADROTOR_KF_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_kf_status_t quadrotor_kf_update_pose(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                               const quadrotor_kf_update_pose_in_t *in,
                                               quadrotor_kf_update_pose_out_t *out)
{
    quadrotor_kf_state_t after;
    quadrotor_kf_update_pose_out_t answer;
    const quadrotor_kf_status_t status = quadrotor_kf_update_pose_core(state, &after, params, in->pose,
        params->gate_pose, &answer);

    if (status >= QUADROTOR_KF_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

quadrotor_kf_status_t quadrotor_kf_step(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                        const quadrotor_kf_step_in_t *in, quadrotor_kf_step_out_t *out)
{
    quadrotor_kf_step_out_t answer;
    const quadrotor_kf_status_t status = quadrotor_kf_step_core(state, state, params, in->rotor_1, in->rotor_2,
        in->rotor_3, in->rotor_4, in->has_pose, in->pose, &answer);

    if (status >= QUADROTOR_KF_OK)
    {
        *out = answer;
    }
    return status;
}

quadrotor_kf_status_t quadrotor_kf_inflate(quadrotor_kf_state_t *state, const quadrotor_kf_params_t *params,
                                           const quadrotor_kf_inflate_in_t *in)
{
    quadrotor_kf_state_t after;
    const quadrotor_kf_status_t status = quadrotor_kf_inflate_core(state, &after, in->factor);

    (void)params;

    if (status >= QUADROTOR_KF_OK)
    {
        *state = after;
    }
    return status;
}

const char *quadrotor_kf_model(void)
{
    return "e2e766d7";
}

const char *quadrotor_kf_status_text(quadrotor_kf_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case QUADROTOR_KF_OK:
            text = "ok";
            break;
        case QUADROTOR_KF_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case QUADROTOR_KF_CLAMPED:
            text = "a variance was held at its ceiling or floor";
            break;
        case QUADROTOR_KF_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case QUADROTOR_KF_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case QUADROTOR_KF_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case QUADROTOR_KF_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case QUADROTOR_KF_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case QUADROTOR_KF_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
