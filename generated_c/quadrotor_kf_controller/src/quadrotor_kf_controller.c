/* quadrotor_kf_controller: see quadrotor_kf_controller.h. Written by plantc 0.1.0 from model 32695685. */
#include "quadrotor_kf_controller.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "quadrotor_kf_controller checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static quadrotor_kf_controller_status_t quadrotor_kf_controller_higher(quadrotor_kf_controller_status_t first, quadrotor_kf_controller_status_t second)
{
    return (first > second) ? first : second;
}

/* Whether every element is within its bounds; false for NaN. A comparison that decides what is stored is written
 * (... == true), from which Frama-C sees that NaN does not pass. */
static bool quadrotor_kf_controller_estimator_is_held(const float covariance[78])
{
    bool held = true;

    for (uint32_t i = 0U; (i < 78U) && held; i++)
    {
        held = ((covariance[i] >= -1.0e9f) == true)
               && ((covariance[i] <= 1.0e9f) == true);
    }
    return held
           && ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[12] >= 1.0e-20f) == true)
           && ((covariance[23] >= 1.0e-20f) == true)
           && ((covariance[33] >= 1.0e-20f) == true)
           && ((covariance[42] >= 1.0e-20f) == true)
           && ((covariance[50] >= 1.0e-20f) == true)
           && ((covariance[57] >= 1.0e-20f) == true)
           && ((covariance[63] >= 1.0e-20f) == true)
           && ((covariance[68] >= 1.0e-20f) == true)
           && ((covariance[72] >= 1.0e-20f) == true)
           && ((covariance[75] >= 1.0e-20f) == true)
           && ((covariance[77] >= 1.0e-20f) == true);
}

/* Keeps the variances between floor and ceiling; called only when one is outside. Scaling row and column together keeps
 * the matrix positive definite. What lies beside the diagonal is then compared with its bounds. */
static quadrotor_kf_controller_status_t quadrotor_kf_controller_estimator_hold_variances(float covariance[78])
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;
    uint32_t at = 0U;

    for (uint32_t i = 0U; i < 12U; i++)
    {
        if (!((covariance[at] >= 0.0f) == true))
        {
            status = QUADROTOR_KF_CONTROLLER_NOT_POSITIVE;
        }
        at = at + (12U - i);
    }
    at = 0U;
    for (uint32_t i = 0U; (i < 12U) && (status >= QUADROTOR_KF_CONTROLLER_OK); i++)
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
                other = other + ((12U - 1U) - j);
            }
            for (uint32_t j = i + 1U; j < 12U; j++)
            {
                covariance[at + (j - i)] = covariance[at + (j - i)] * factor;
            }
            covariance[at] = ceiling_i;
            status = QUADROTOR_KF_CONTROLLER_CLAMPED;
        }
        else if (covariance[at] < floor_i)
        {
            covariance[at] = floor_i;
            status = QUADROTOR_KF_CONTROLLER_CLAMPED;
        }
        else
        {
            /* within its bounds */
        }
        at = at + (12U - i);
    }
    if ((status >= QUADROTOR_KF_CONTROLLER_OK) && (!quadrotor_kf_controller_estimator_is_held(covariance)))
    {
        status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
    }
    return status;
}

/* Whether a covariance is within its bounds beyond doubt. Elements that are small, and whose sum is not far below
 * zero, are not far below zero themselves. False for NaN. */
static bool quadrotor_kf_controller_estimator_is_bounded(const float covariance[78])
{
    return ((covariance[0] >= 1.0e-20f) == true)
           && ((covariance[12] >= 1.0e-20f) == true)
           && ((covariance[23] >= 1.0e-20f) == true)
           && ((covariance[33] >= 1.0e-20f) == true)
           && ((covariance[42] >= 1.0e-20f) == true)
           && ((covariance[50] >= 1.0e-20f) == true)
           && ((covariance[57] >= 1.0e-20f) == true)
           && ((covariance[63] >= 1.0e-20f) == true)
           && ((covariance[68] >= 1.0e-20f) == true)
           && ((covariance[72] >= 1.0e-20f) == true)
           && ((covariance[75] >= 1.0e-20f) == true)
           && ((covariance[77] >= 1.0e-20f) == true)
           && (((((((((covariance[0] + covariance[12]) + covariance[23]) + covariance[33]) + covariance[42]) +
               covariance[50]) + covariance[57]) + covariance[63]) <= 9.9e8f) == true)
           && (((((covariance[68] + covariance[72]) + covariance[75]) + covariance[77]) <= 9.9e8f) == true)
           && ((covariance[1] <= 6.2e7f) == true)
           && ((covariance[2] <= 6.2e7f) == true)
           && ((covariance[3] <= 6.2e7f) == true)
           && ((covariance[4] <= 6.2e7f) == true)
           && ((covariance[5] <= 6.2e7f) == true)
           && ((covariance[6] <= 6.2e7f) == true)
           && ((covariance[7] <= 6.2e7f) == true)
           && ((covariance[8] <= 6.2e7f) == true)
           && (((((((((covariance[1] + covariance[2]) + covariance[3]) + covariance[4]) + covariance[5]) +
               covariance[6]) + covariance[7]) + covariance[8]) >= -5.0e8f) == true)
           && ((covariance[9] <= 6.2e7f) == true)
           && ((covariance[10] <= 6.2e7f) == true)
           && ((covariance[11] <= 6.2e7f) == true)
           && ((covariance[13] <= 6.2e7f) == true)
           && ((covariance[14] <= 6.2e7f) == true)
           && ((covariance[15] <= 6.2e7f) == true)
           && ((covariance[16] <= 6.2e7f) == true)
           && ((covariance[17] <= 6.2e7f) == true)
           && (((((((((covariance[9] + covariance[10]) + covariance[11]) + covariance[13]) + covariance[14]) +
               covariance[15]) + covariance[16]) + covariance[17]) >= -5.0e8f) == true)
           && ((covariance[18] <= 6.2e7f) == true)
           && ((covariance[19] <= 6.2e7f) == true)
           && ((covariance[20] <= 6.2e7f) == true)
           && ((covariance[21] <= 6.2e7f) == true)
           && ((covariance[22] <= 6.2e7f) == true)
           && ((covariance[24] <= 6.2e7f) == true)
           && ((covariance[25] <= 6.2e7f) == true)
           && ((covariance[26] <= 6.2e7f) == true)
           && (((((((((covariance[18] + covariance[19]) + covariance[20]) + covariance[21]) + covariance[22]) +
               covariance[24]) + covariance[25]) + covariance[26]) >= -5.0e8f) == true)
           && ((covariance[27] <= 6.2e7f) == true)
           && ((covariance[28] <= 6.2e7f) == true)
           && ((covariance[29] <= 6.2e7f) == true)
           && ((covariance[30] <= 6.2e7f) == true)
           && ((covariance[31] <= 6.2e7f) == true)
           && ((covariance[32] <= 6.2e7f) == true)
           && ((covariance[34] <= 6.2e7f) == true)
           && ((covariance[35] <= 6.2e7f) == true)
           && (((((((((covariance[27] + covariance[28]) + covariance[29]) + covariance[30]) + covariance[31]) +
               covariance[32]) + covariance[34]) + covariance[35]) >= -5.0e8f) == true)
           && ((covariance[36] <= 6.2e7f) == true)
           && ((covariance[37] <= 6.2e7f) == true)
           && ((covariance[38] <= 6.2e7f) == true)
           && ((covariance[39] <= 6.2e7f) == true)
           && ((covariance[40] <= 6.2e7f) == true)
           && ((covariance[41] <= 6.2e7f) == true)
           && ((covariance[43] <= 6.2e7f) == true)
           && ((covariance[44] <= 6.2e7f) == true)
           && (((((((((covariance[36] + covariance[37]) + covariance[38]) + covariance[39]) + covariance[40]) +
               covariance[41]) + covariance[43]) + covariance[44]) >= -5.0e8f) == true)
           && ((covariance[45] <= 6.2e7f) == true)
           && ((covariance[46] <= 6.2e7f) == true)
           && ((covariance[47] <= 6.2e7f) == true)
           && ((covariance[48] <= 6.2e7f) == true)
           && ((covariance[49] <= 6.2e7f) == true)
           && ((covariance[51] <= 6.2e7f) == true)
           && ((covariance[52] <= 6.2e7f) == true)
           && ((covariance[53] <= 6.2e7f) == true)
           && (((((((((covariance[45] + covariance[46]) + covariance[47]) + covariance[48]) + covariance[49]) +
               covariance[51]) + covariance[52]) + covariance[53]) >= -5.0e8f) == true)
           && ((covariance[54] <= 6.2e7f) == true)
           && ((covariance[55] <= 6.2e7f) == true)
           && ((covariance[56] <= 6.2e7f) == true)
           && ((covariance[58] <= 6.2e7f) == true)
           && ((covariance[59] <= 6.2e7f) == true)
           && ((covariance[60] <= 6.2e7f) == true)
           && ((covariance[61] <= 6.2e7f) == true)
           && ((covariance[62] <= 6.2e7f) == true)
           && (((((((((covariance[54] + covariance[55]) + covariance[56]) + covariance[58]) + covariance[59]) +
               covariance[60]) + covariance[61]) + covariance[62]) >= -5.0e8f) == true)
           && ((covariance[64] <= 6.2e7f) == true)
           && ((covariance[65] <= 6.2e7f) == true)
           && ((covariance[66] <= 6.2e7f) == true)
           && ((covariance[67] <= 6.2e7f) == true)
           && ((covariance[69] <= 6.2e7f) == true)
           && ((covariance[70] <= 6.2e7f) == true)
           && ((covariance[71] <= 6.2e7f) == true)
           && ((covariance[73] <= 6.2e7f) == true)
           && (((((((((covariance[64] + covariance[65]) + covariance[66]) + covariance[67]) + covariance[69]) +
               covariance[70]) + covariance[71]) + covariance[73]) >= -5.0e8f) == true)
           && ((covariance[74] <= 2.5e8f) == true)
           && ((covariance[76] <= 2.5e8f) == true)
           && (((covariance[74] + covariance[76]) >= -5.0e8f) == true);
}

/* Between the steps of one update: the correction d, what the rows give, and the rows of P just measured. */
typedef struct
{
    float delta[12];
    float loss_a[10];
    float loss_b[10];
    float cross_b[10];
    float row_a[10];
    float row_b[10];
    float row_variance[12];
    float nis;
} quadrotor_kf_controller_estimator_rows_t;

/* Rows a and b measure the first two states: d = d + K e, in the order that has these two last. loss is -K,
 * cross is P H'; b is after a. The measured rows of P become r K. */
static void quadrotor_kf_controller_estimator_gain(const float p[78], float q[78], quadrotor_kf_controller_estimator_rows_t *work,
                                                   const float residual[2], const float r[2], float variance[2])
{
    const float a_0 = p[0];
    const float a_1 = p[1];
    const float a_2 = p[2];
    const float a_3 = p[3];
    const float a_4 = p[4];
    const float a_5 = p[5];
    const float a_6 = p[6];
    const float a_7 = p[7];
    const float a_8 = p[8];
    const float a_9 = p[9];
    const float a_10 = p[10];
    const float a_11 = p[11];
    const float p_1 = p[12];
    const float p_2 = p[13];
    const float p_3 = p[14];
    const float p_4 = p[15];
    const float p_5 = p[16];
    const float p_6 = p[17];
    const float p_7 = p[18];
    const float p_8 = p[19];
    const float p_9 = p[20];
    const float p_10 = p[21];
    const float p_11 = p[22];
    const float s_a = r[0] + a_0;
    const float minus_per_a = -1.0f / ((s_a >= 1.0e-20f) ? s_a : 1.0f);
    const float minus_r_a = -r[0];
    const float minus_r_b = -r[1];
    const float n_0 = a_0 * minus_per_a;
    const float n_1 = a_1 * minus_per_a;
    const float n_2 = a_2 * minus_per_a;
    const float n_3 = a_3 * minus_per_a;
    const float n_4 = a_4 * minus_per_a;
    const float n_5 = a_5 * minus_per_a;
    const float n_6 = a_6 * minus_per_a;
    const float n_7 = a_7 * minus_per_a;
    const float n_8 = a_8 * minus_per_a;
    const float n_9 = a_9 * minus_per_a;
    const float n_10 = a_10 * minus_per_a;
    const float n_11 = a_11 * minus_per_a;
    const float b_0 = n_1 * minus_r_a;
    const float b_1 = p_1 + (a_1 * n_1);
    const float b_2 = p_2 + (a_2 * n_1);
    const float b_3 = p_3 + (a_3 * n_1);
    const float b_4 = p_4 + (a_4 * n_1);
    const float b_5 = p_5 + (a_5 * n_1);
    const float b_6 = p_6 + (a_6 * n_1);
    const float b_7 = p_7 + (a_7 * n_1);
    const float b_8 = p_8 + (a_8 * n_1);
    const float b_9 = p_9 + (a_9 * n_1);
    const float b_10 = p_10 + (a_10 * n_1);
    const float b_11 = p_11 + (a_11 * n_1);
    const float s_b = r[1] + b_1;
    const float minus_per_b = -1.0f / ((s_b >= 1.0e-20f) ? s_b : 1.0f);
    const float k_0 = b_0 * minus_per_b;
    const float k_1 = b_1 * minus_per_b;
    const float k_2 = b_2 * minus_per_b;
    const float k_3 = b_3 * minus_per_b;
    const float k_4 = b_4 * minus_per_b;
    const float k_5 = b_5 * minus_per_b;
    const float k_6 = b_6 * minus_per_b;
    const float k_7 = b_7 * minus_per_b;
    const float k_8 = b_8 * minus_per_b;
    const float k_9 = b_9 * minus_per_b;
    const float k_10 = b_10 * minus_per_b;
    const float k_11 = b_11 * minus_per_b;

    work->loss_a[0] = n_2;
    work->loss_a[1] = n_3;
    work->loss_a[2] = n_4;
    work->loss_a[3] = n_5;
    work->loss_a[4] = n_6;
    work->loss_a[5] = n_7;
    work->loss_a[6] = n_8;
    work->loss_a[7] = n_9;
    work->loss_a[8] = n_10;
    work->loss_a[9] = n_11;
    work->cross_b[0] = b_2;
    work->cross_b[1] = b_3;
    work->cross_b[2] = b_4;
    work->cross_b[3] = b_5;
    work->cross_b[4] = b_6;
    work->cross_b[5] = b_7;
    work->cross_b[6] = b_8;
    work->cross_b[7] = b_9;
    work->cross_b[8] = b_10;
    work->cross_b[9] = b_11;
    work->loss_b[0] = k_2;
    work->loss_b[1] = k_3;
    work->loss_b[2] = k_4;
    work->loss_b[3] = k_5;
    work->loss_b[4] = k_6;
    work->loss_b[5] = k_7;
    work->loss_b[6] = k_8;
    work->loss_b[7] = k_9;
    work->loss_b[8] = k_10;
    work->loss_b[9] = k_11;
    work->row_b[0] = k_2 * minus_r_b;
    work->row_b[1] = k_3 * minus_r_b;
    work->row_b[2] = k_4 * minus_r_b;
    work->row_b[3] = k_5 * minus_r_b;
    work->row_b[4] = k_6 * minus_r_b;
    work->row_b[5] = k_7 * minus_r_b;
    work->row_b[6] = k_8 * minus_r_b;
    work->row_b[7] = k_9 * minus_r_b;
    work->row_b[8] = k_10 * minus_r_b;
    work->row_b[9] = k_11 * minus_r_b;
    work->row_a[0] = (n_2 * minus_r_a) + (b_2 * k_0);
    work->row_a[1] = (n_3 * minus_r_a) + (b_3 * k_0);
    work->row_a[2] = (n_4 * minus_r_a) + (b_4 * k_0);
    work->row_a[3] = (n_5 * minus_r_a) + (b_5 * k_0);
    work->row_a[4] = (n_6 * minus_r_a) + (b_6 * k_0);
    work->row_a[5] = (n_7 * minus_r_a) + (b_7 * k_0);
    work->row_a[6] = (n_8 * minus_r_a) + (b_8 * k_0);
    work->row_a[7] = (n_9 * minus_r_a) + (b_9 * k_0);
    work->row_a[8] = (n_10 * minus_r_a) + (b_10 * k_0);
    work->row_a[9] = (n_11 * minus_r_a) + (b_11 * k_0);
    q[75] = (n_0 * minus_r_a) + (b_0 * k_0);
    q[76] = k_0 * minus_r_b;
    q[77] = k_1 * minus_r_b;
    variance[0] = s_a;
    variance[1] = s_b;

    const float d_0 = work->delta[0];
    const float d_1 = work->delta[1];
    const float minus_e_a = d_0 - residual[0];
    const float minus_e_b = (d_1 + (n_1 * minus_e_a)) - residual[1];
    work->delta[0] = (work->delta[2] + (n_2 * minus_e_a)) + (k_2 * minus_e_b);
    work->delta[1] = (work->delta[3] + (n_3 * minus_e_a)) + (k_3 * minus_e_b);
    work->delta[2] = (work->delta[4] + (n_4 * minus_e_a)) + (k_4 * minus_e_b);
    work->delta[3] = (work->delta[5] + (n_5 * minus_e_a)) + (k_5 * minus_e_b);
    work->delta[4] = (work->delta[6] + (n_6 * minus_e_a)) + (k_6 * minus_e_b);
    work->delta[5] = (work->delta[7] + (n_7 * minus_e_a)) + (k_7 * minus_e_b);
    work->delta[6] = (work->delta[8] + (n_8 * minus_e_a)) + (k_8 * minus_e_b);
    work->delta[7] = (work->delta[9] + (n_9 * minus_e_a)) + (k_9 * minus_e_b);
    work->delta[8] = (work->delta[10] + (n_10 * minus_e_a)) + (k_10 * minus_e_b);
    work->delta[9] = (work->delta[11] + (n_11 * minus_e_a)) + (k_11 * minus_e_b);
    work->delta[10] = (d_0 + (n_0 * minus_e_a)) + (k_0 * minus_e_b);
    work->delta[11] = (d_1 + (n_1 * minus_e_a)) + (k_1 * minus_e_b);
    const float nis = work->nis - (minus_e_a * (minus_per_a * minus_e_a));
    work->nis = nis - (minus_e_b * (minus_per_b * minus_e_b));
}

/* The rows just measured become the last two columns. */
static void quadrotor_kf_controller_estimator_place(float q[78], const quadrotor_kf_controller_estimator_rows_t *work)
{
    q[10] = work->row_a[0];
    q[11] = work->row_b[0];
    q[21] = work->row_a[1];
    q[22] = work->row_b[1];
    q[31] = work->row_a[2];
    q[32] = work->row_b[2];
    q[40] = work->row_a[3];
    q[41] = work->row_b[3];
    q[48] = work->row_a[4];
    q[49] = work->row_b[4];
    q[55] = work->row_a[5];
    q[56] = work->row_b[5];
    q[61] = work->row_a[6];
    q[62] = work->row_b[6];
    q[66] = work->row_a[7];
    q[67] = work->row_b[7];
    q[70] = work->row_a[8];
    q[71] = work->row_b[8];
    q[73] = work->row_a[9];
    q[74] = work->row_b[9];
}

/* P = P - K s K' for what was not measured, two rows at once. */
static void quadrotor_kf_controller_estimator_downdate(const float p[78], float q[78], const quadrotor_kf_controller_estimator_rows_t *work)
{
    const float a_2 = p[2];
    const float b_2 = work->cross_b[0];
    const float a_3 = p[3];
    const float b_3 = work->cross_b[1];
    const float a_4 = p[4];
    const float b_4 = work->cross_b[2];
    const float a_5 = p[5];
    const float b_5 = work->cross_b[3];
    const float a_6 = p[6];
    const float b_6 = work->cross_b[4];
    const float a_7 = p[7];
    const float b_7 = work->cross_b[5];
    const float a_8 = p[8];
    const float b_8 = work->cross_b[6];
    const float a_9 = p[9];
    const float b_9 = work->cross_b[7];
    const float a_10 = p[10];
    const float b_10 = work->cross_b[8];
    const float a_11 = p[11];
    const float b_11 = work->cross_b[9];

    const float n_2 = work->loss_a[0];
    const float k_2 = work->loss_b[0];
    const float p_2_2 = p[23];
    const float p_2_3 = p[24];
    const float p_2_4 = p[25];
    const float p_2_5 = p[26];
    const float p_2_6 = p[27];
    const float p_2_7 = p[28];
    const float p_2_8 = p[29];
    const float p_2_9 = p[30];
    const float p_2_10 = p[31];
    const float p_2_11 = p[32];
    q[0] = (p_2_2 + (a_2 * n_2)) + (b_2 * k_2);
    q[1] = (p_2_3 + (a_3 * n_2)) + (b_3 * k_2);
    q[2] = (p_2_4 + (a_4 * n_2)) + (b_4 * k_2);
    q[3] = (p_2_5 + (a_5 * n_2)) + (b_5 * k_2);
    q[4] = (p_2_6 + (a_6 * n_2)) + (b_6 * k_2);
    q[5] = (p_2_7 + (a_7 * n_2)) + (b_7 * k_2);
    q[6] = (p_2_8 + (a_8 * n_2)) + (b_8 * k_2);
    q[7] = (p_2_9 + (a_9 * n_2)) + (b_9 * k_2);
    q[8] = (p_2_10 + (a_10 * n_2)) + (b_10 * k_2);
    q[9] = (p_2_11 + (a_11 * n_2)) + (b_11 * k_2);

    const float n_3 = work->loss_a[1];
    const float k_3 = work->loss_b[1];
    const float p_3_3 = p[33];
    const float p_3_4 = p[34];
    const float p_3_5 = p[35];
    const float p_3_6 = p[36];
    const float p_3_7 = p[37];
    const float p_3_8 = p[38];
    const float p_3_9 = p[39];
    const float p_3_10 = p[40];
    const float p_3_11 = p[41];
    q[12] = (p_3_3 + (a_3 * n_3)) + (b_3 * k_3);
    q[13] = (p_3_4 + (a_4 * n_3)) + (b_4 * k_3);
    q[14] = (p_3_5 + (a_5 * n_3)) + (b_5 * k_3);
    q[15] = (p_3_6 + (a_6 * n_3)) + (b_6 * k_3);
    q[16] = (p_3_7 + (a_7 * n_3)) + (b_7 * k_3);
    q[17] = (p_3_8 + (a_8 * n_3)) + (b_8 * k_3);
    q[18] = (p_3_9 + (a_9 * n_3)) + (b_9 * k_3);
    q[19] = (p_3_10 + (a_10 * n_3)) + (b_10 * k_3);
    q[20] = (p_3_11 + (a_11 * n_3)) + (b_11 * k_3);

    const float n_4 = work->loss_a[2];
    const float k_4 = work->loss_b[2];
    const float p_4_4 = p[42];
    const float p_4_5 = p[43];
    const float p_4_6 = p[44];
    const float p_4_7 = p[45];
    const float p_4_8 = p[46];
    const float p_4_9 = p[47];
    const float p_4_10 = p[48];
    const float p_4_11 = p[49];
    q[23] = (p_4_4 + (a_4 * n_4)) + (b_4 * k_4);
    q[24] = (p_4_5 + (a_5 * n_4)) + (b_5 * k_4);
    q[25] = (p_4_6 + (a_6 * n_4)) + (b_6 * k_4);
    q[26] = (p_4_7 + (a_7 * n_4)) + (b_7 * k_4);
    q[27] = (p_4_8 + (a_8 * n_4)) + (b_8 * k_4);
    q[28] = (p_4_9 + (a_9 * n_4)) + (b_9 * k_4);
    q[29] = (p_4_10 + (a_10 * n_4)) + (b_10 * k_4);
    q[30] = (p_4_11 + (a_11 * n_4)) + (b_11 * k_4);

    const float n_5 = work->loss_a[3];
    const float k_5 = work->loss_b[3];
    const float p_5_5 = p[50];
    const float p_5_6 = p[51];
    const float p_5_7 = p[52];
    const float p_5_8 = p[53];
    const float p_5_9 = p[54];
    const float p_5_10 = p[55];
    const float p_5_11 = p[56];
    q[33] = (p_5_5 + (a_5 * n_5)) + (b_5 * k_5);
    q[34] = (p_5_6 + (a_6 * n_5)) + (b_6 * k_5);
    q[35] = (p_5_7 + (a_7 * n_5)) + (b_7 * k_5);
    q[36] = (p_5_8 + (a_8 * n_5)) + (b_8 * k_5);
    q[37] = (p_5_9 + (a_9 * n_5)) + (b_9 * k_5);
    q[38] = (p_5_10 + (a_10 * n_5)) + (b_10 * k_5);
    q[39] = (p_5_11 + (a_11 * n_5)) + (b_11 * k_5);

    const float n_6 = work->loss_a[4];
    const float k_6 = work->loss_b[4];
    const float p_6_6 = p[57];
    const float p_6_7 = p[58];
    const float p_6_8 = p[59];
    const float p_6_9 = p[60];
    const float p_6_10 = p[61];
    const float p_6_11 = p[62];
    q[42] = (p_6_6 + (a_6 * n_6)) + (b_6 * k_6);
    q[43] = (p_6_7 + (a_7 * n_6)) + (b_7 * k_6);
    q[44] = (p_6_8 + (a_8 * n_6)) + (b_8 * k_6);
    q[45] = (p_6_9 + (a_9 * n_6)) + (b_9 * k_6);
    q[46] = (p_6_10 + (a_10 * n_6)) + (b_10 * k_6);
    q[47] = (p_6_11 + (a_11 * n_6)) + (b_11 * k_6);

    const float n_7 = work->loss_a[5];
    const float k_7 = work->loss_b[5];
    const float p_7_7 = p[63];
    const float p_7_8 = p[64];
    const float p_7_9 = p[65];
    const float p_7_10 = p[66];
    const float p_7_11 = p[67];
    q[50] = (p_7_7 + (a_7 * n_7)) + (b_7 * k_7);
    q[51] = (p_7_8 + (a_8 * n_7)) + (b_8 * k_7);
    q[52] = (p_7_9 + (a_9 * n_7)) + (b_9 * k_7);
    q[53] = (p_7_10 + (a_10 * n_7)) + (b_10 * k_7);
    q[54] = (p_7_11 + (a_11 * n_7)) + (b_11 * k_7);

    const float n_8 = work->loss_a[6];
    const float k_8 = work->loss_b[6];
    const float p_8_8 = p[68];
    const float p_8_9 = p[69];
    const float p_8_10 = p[70];
    const float p_8_11 = p[71];
    q[57] = (p_8_8 + (a_8 * n_8)) + (b_8 * k_8);
    q[58] = (p_8_9 + (a_9 * n_8)) + (b_9 * k_8);
    q[59] = (p_8_10 + (a_10 * n_8)) + (b_10 * k_8);
    q[60] = (p_8_11 + (a_11 * n_8)) + (b_11 * k_8);

    const float n_9 = work->loss_a[7];
    const float k_9 = work->loss_b[7];
    const float p_9_9 = p[72];
    const float p_9_10 = p[73];
    const float p_9_11 = p[74];
    q[63] = (p_9_9 + (a_9 * n_9)) + (b_9 * k_9);
    q[64] = (p_9_10 + (a_10 * n_9)) + (b_10 * k_9);
    q[65] = (p_9_11 + (a_11 * n_9)) + (b_11 * k_9);

    const float n_10 = work->loss_a[8];
    const float k_10 = work->loss_b[8];
    const float p_10_10 = p[75];
    const float p_10_11 = p[76];
    q[68] = (p_10_10 + (a_10 * n_10)) + (b_10 * k_10);
    q[69] = (p_10_11 + (a_11 * n_10)) + (b_11 * k_10);

    const float n_11 = work->loss_a[9];
    const float k_11 = work->loss_b[9];
    const float p_11_11 = p[77];
    q[72] = (p_11_11 + (a_11 * n_11)) + (b_11 * k_11);
}

static quadrotor_kf_controller_status_t quadrotor_kf_controller_estimator_init_core(
    quadrotor_kf_controller_estimator_state_t *after, const quadrotor_kf_controller_estimator_params_t *params)
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

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
          && ((params->variance_pose[6] >= 1.0e-12f) == true) && ((params->variance_pose[6] <= 1000000.0f) == true)
          && ((params->variance_pose[7] >= 1.0e-12f) == true) && ((params->variance_pose[7] <= 1000000.0f) == true)
          && ((params->variance_pose[8] >= 1.0e-12f) == true) && ((params->variance_pose[8] <= 1000000.0f) == true)
          && ((params->variance_pose[9] >= 1.0e-12f) == true) && ((params->variance_pose[9] <= 1000000.0f) == true)
          && ((params->variance_pose[10] >= 1.0e-12f) == true) && ((params->variance_pose[10] <= 1000000.0f) == true)
          && ((params->variance_pose[11] >= 1.0e-12f) == true) && ((params->variance_pose[11] <= 1000000.0f) == true)
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
        status = QUADROTOR_KF_CONTROLLER_BAD_PARAM;
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
            after->covariance[i] = 0.0f;
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
        if (!quadrotor_kf_controller_estimator_is_bounded(after->covariance))
        {
            status = quadrotor_kf_controller_estimator_hold_variances(after->covariance);
        }
    }
    return status;
}

/* 146 additions, 117 multiplications, 1 negation. */
static quadrotor_kf_controller_status_t quadrotor_kf_controller_estimator_predict_core(
    const quadrotor_kf_controller_estimator_state_t *before, quadrotor_kf_controller_estimator_state_t *after,
    const quadrotor_kf_controller_estimator_params_t *params, const float rotor_1, const float rotor_2,
    const float rotor_3, const float rotor_4)
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

    after->rejected_pose = before->rejected_pose;

    if (!(((rotor_1 >= -1000.0f) == true) && ((rotor_1 <= 1000.0f) == true) && ((rotor_2 >= -1000.0f) == true)
          && ((rotor_2 <= 1000.0f) == true) && ((rotor_3 >= -1000.0f) == true) && ((rotor_3 <= 1000.0f) == true)
          && ((rotor_4 >= -1000.0f) == true) && ((rotor_4 <= 1000.0f) == true)))
    {
        status = QUADROTOR_KF_CONTROLLER_BAD_INPUT;
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
        const float vx = before->vx;
        after->x = before->x + (vx * 0.025f);
        const float pitch = before->pitch;
        after->vx = vx + (pitch * 0.24525f);
        const float vy = before->vy;
        after->y = before->y + (vy * 0.025f);
        const float roll = before->roll;
        after->vy = vy - (roll * 0.24525f);
        const float vz = before->vz;
        after->z = 30.0f + ((before->z - 30.0f) + (vz * 0.025f));
        const float v = rotor_1 - 212.7183f;
        const float v_2 = rotor_2 - 212.7183f;
        const float v_3 = rotor_3 - 212.7183f;
        const float v_4 = rotor_4 - 212.7183f;
        const float v_5 = (((0.0005764666f * v) + (0.0005764666f * v_2)) + (0.0005764666f * v_3)) + (0.0005764666f *
            v_4);
        after->vz = vz + v_5;
        const float roll_rate = before->roll_rate;
        after->roll = roll + (roll_rate * 0.025f);
        const float v_6 = v * 0.017080491f;
        const float v_7 = v_2 * 0.017080491f;
        const float v_8 = v_3 * 0.017080491f;
        const float v_9 = v_4 * 0.017080491f;
        after->roll_rate = roll_rate + ((((-v_6) - v_7) + v_8) + v_9);
        const float pitch_rate = before->pitch_rate;
        after->pitch = pitch + (pitch_rate * 0.025f);
        after->pitch_rate = pitch_rate + ((v_8 + (v_7 - v_6)) - v_9);
        const float yaw_rate = before->yaw_rate;
        after->yaw = before->yaw + (yaw_rate * 0.025f);
        const float v_10 = (((v * 0.00082390895f) - (v_2 * 0.00082390895f)) + (v_3 * 0.00082390895f)) - (v_4 *
            0.00082390895f);
        after->yaw_rate = yaw_rate + v_10;

        /* P = F P F' + Q */
        {
            const float p_0_1 = before->covariance[1];
            const float p_1_1 = before->covariance[12];
            const float v_11 = p_0_1 + (0.025f * p_1_1);
            after->covariance[0] = params->variance_step_x + ((before->covariance[0] + (0.025f * p_0_1)) + (0.025f *
                v_11));
            const float p_1_8 = before->covariance[19];
            const float v_12 = before->covariance[8] + (0.025f * p_1_8);
            after->covariance[1] = v_11 + (0.24525f * v_12);
            const float p_1_2 = before->covariance[13];
            const float p_1_3 = before->covariance[14];
            const float v_13 = before->covariance[3] + (0.025f * p_1_3);
            after->covariance[2] = (before->covariance[2] + (0.025f * p_1_2)) + (0.025f * v_13);
            const float p_1_6 = before->covariance[17];
            const float v_14 = before->covariance[6] + (0.025f * p_1_6);
            after->covariance[3] = v_13 - (0.24525f * v_14);
            const float p_1_4 = before->covariance[15];
            const float p_1_5 = before->covariance[16];
            const float v_15 = before->covariance[5] + (0.025f * p_1_5);
            after->covariance[4] = (before->covariance[4] + (0.025f * p_1_4)) + (0.025f * v_15);
            after->covariance[5] = v_15;
            const float p_1_7 = before->covariance[18];
            const float v_16 = before->covariance[7] + (0.025f * p_1_7);
            after->covariance[6] = v_14 + (0.025f * v_16);
            after->covariance[7] = v_16;
            const float p_1_9 = before->covariance[20];
            const float v_17 = before->covariance[9] + (0.025f * p_1_9);
            after->covariance[8] = v_12 + (0.025f * v_17);
            after->covariance[9] = v_17;
            const float p_1_10 = before->covariance[21];
            const float p_1_11 = before->covariance[22];
            const float v_18 = before->covariance[11] + (0.025f * p_1_11);
            after->covariance[10] = (before->covariance[10] + (0.025f * p_1_10)) + (0.025f * v_18);
            after->covariance[11] = v_18;
            const float p_8_8 = before->covariance[68];
            const float v_19 = p_1_8 + (0.24525f * p_8_8);
            after->covariance[12] = params->variance_step_vx + ((p_1_1 + (0.24525f * p_1_8)) + (0.24525f * v_19));
            const float p_2_8 = before->covariance[29];
            const float p_3_8 = before->covariance[38];
            const float v_20 = p_1_3 + (0.24525f * p_3_8);
            after->covariance[13] = (p_1_2 + (0.24525f * p_2_8)) + (0.025f * v_20);
            const float p_6_8 = before->covariance[59];
            const float v_21 = 0.24525f * p_6_8;
            const float v_22 = p_1_6 + v_21;
            after->covariance[14] = v_20 - (0.24525f * v_22);
            const float p_4_8 = before->covariance[46];
            const float p_5_8 = before->covariance[53];
            const float v_23 = p_1_5 + (0.24525f * p_5_8);
            after->covariance[15] = (p_1_4 + (0.24525f * p_4_8)) + (0.025f * v_23);
            after->covariance[16] = v_23;
            const float p_7_8 = before->covariance[64];
            const float v_24 = p_1_7 + (0.24525f * p_7_8);
            after->covariance[17] = v_22 + (0.025f * v_24);
            after->covariance[18] = v_24;
            const float p_8_9 = before->covariance[69];
            const float v_25 = p_1_9 + (0.24525f * p_8_9);
            after->covariance[19] = v_19 + (0.025f * v_25);
            after->covariance[20] = v_25;
            const float p_8_10 = before->covariance[70];
            const float p_8_11 = before->covariance[71];
            const float v_26 = p_1_11 + (0.24525f * p_8_11);
            after->covariance[21] = (p_1_10 + (0.24525f * p_8_10)) + (0.025f * v_26);
            after->covariance[22] = v_26;
            const float p_2_3 = before->covariance[24];
            const float p_3_3 = before->covariance[33];
            const float v_27 = p_2_3 + (0.025f * p_3_3);
            after->covariance[23] = params->variance_step_y + ((before->covariance[23] + (0.025f * p_2_3)) + (0.025f *
                v_27));
            const float p_3_6 = before->covariance[36];
            const float v_28 = before->covariance[27] + (0.025f * p_3_6);
            after->covariance[24] = v_27 - (0.24525f * v_28);
            const float p_3_4 = before->covariance[34];
            const float p_3_5 = before->covariance[35];
            const float v_29 = before->covariance[26] + (0.025f * p_3_5);
            after->covariance[25] = (before->covariance[25] + (0.025f * p_3_4)) + (0.025f * v_29);
            after->covariance[26] = v_29;
            const float p_3_7 = before->covariance[37];
            const float v_30 = before->covariance[28] + (0.025f * p_3_7);
            after->covariance[27] = v_28 + (0.025f * v_30);
            after->covariance[28] = v_30;
            const float p_3_9 = before->covariance[39];
            const float v_31 = before->covariance[30] + (0.025f * p_3_9);
            after->covariance[29] = (p_2_8 + (0.025f * p_3_8)) + (0.025f * v_31);
            after->covariance[30] = v_31;
            const float p_3_10 = before->covariance[40];
            const float p_3_11 = before->covariance[41];
            const float v_32 = before->covariance[32] + (0.025f * p_3_11);
            after->covariance[31] = (before->covariance[31] + (0.025f * p_3_10)) + (0.025f * v_32);
            after->covariance[32] = v_32;
            const float p_6_6 = before->covariance[57];
            const float v_33 = p_3_6 - (0.24525f * p_6_6);
            after->covariance[33] = params->variance_step_vy + ((p_3_3 - (0.24525f * p_3_6)) - (0.24525f * v_33));
            const float p_4_6 = before->covariance[44];
            const float p_5_6 = before->covariance[51];
            const float v_34 = p_3_5 - (0.24525f * p_5_6);
            after->covariance[34] = (p_3_4 - (0.24525f * p_4_6)) + (0.025f * v_34);
            after->covariance[35] = v_34;
            const float p_6_7 = before->covariance[58];
            const float v_35 = p_3_7 - (0.24525f * p_6_7);
            after->covariance[36] = v_33 + (0.025f * v_35);
            after->covariance[37] = v_35;
            const float p_6_9 = before->covariance[60];
            const float v_36 = p_3_9 - (0.24525f * p_6_9);
            after->covariance[38] = (p_3_8 - v_21) + (0.025f * v_36);
            after->covariance[39] = v_36;
            const float p_6_10 = before->covariance[61];
            const float p_6_11 = before->covariance[62];
            const float v_37 = p_3_11 - (0.24525f * p_6_11);
            after->covariance[40] = (p_3_10 - (0.24525f * p_6_10)) + (0.025f * v_37);
            after->covariance[41] = v_37;
            const float p_4_5 = before->covariance[43];
            const float p_5_5 = before->covariance[50];
            const float v_38 = p_4_5 + (0.025f * p_5_5);
            after->covariance[42] = params->variance_step_z + ((before->covariance[42] + (0.025f * p_4_5)) + (0.025f *
                v_38));
            after->covariance[43] = v_38;
            const float p_5_7 = before->covariance[52];
            const float v_39 = 0.025f * p_5_7;
            const float v_40 = before->covariance[45] + v_39;
            after->covariance[44] = (p_4_6 + (0.025f * p_5_6)) + (0.025f * v_40);
            after->covariance[45] = v_40;
            const float p_5_9 = before->covariance[54];
            const float v_41 = 0.025f * p_5_9;
            const float v_42 = before->covariance[47] + v_41;
            after->covariance[46] = (p_4_8 + (0.025f * p_5_8)) + (0.025f * v_42);
            after->covariance[47] = v_42;
            const float p_5_10 = before->covariance[55];
            const float p_5_11 = before->covariance[56];
            const float v_43 = 0.025f * p_5_11;
            const float v_44 = before->covariance[49] + v_43;
            after->covariance[48] = (before->covariance[48] + (0.025f * p_5_10)) + (0.025f * v_44);
            after->covariance[49] = v_44;
            after->covariance[50] = params->variance_step_vz + p_5_5;
            after->covariance[51] = p_5_6 + v_39;
            after->covariance[52] = p_5_7;
            after->covariance[53] = p_5_8 + v_41;
            after->covariance[54] = p_5_9;
            after->covariance[55] = p_5_10 + v_43;
            after->covariance[56] = p_5_11;
            const float p_7_7 = before->covariance[63];
            const float v_45 = p_6_7 + (0.025f * p_7_7);
            after->covariance[57] = params->variance_step_roll + ((p_6_6 + (0.025f * p_6_7)) + (0.025f * v_45));
            after->covariance[58] = v_45;
            const float p_7_9 = before->covariance[65];
            const float v_46 = 0.025f * p_7_9;
            const float v_47 = p_6_9 + v_46;
            after->covariance[59] = (p_6_8 + (0.025f * p_7_8)) + (0.025f * v_47);
            after->covariance[60] = v_47;
            const float p_7_10 = before->covariance[66];
            const float p_7_11 = before->covariance[67];
            const float v_48 = 0.025f * p_7_11;
            const float v_49 = p_6_11 + v_48;
            after->covariance[61] = (p_6_10 + (0.025f * p_7_10)) + (0.025f * v_49);
            after->covariance[62] = v_49;
            after->covariance[63] = params->variance_step_roll_rate + p_7_7;
            after->covariance[64] = p_7_8 + v_46;
            after->covariance[65] = p_7_9;
            after->covariance[66] = p_7_10 + v_48;
            after->covariance[67] = p_7_11;
            const float p_9_9 = before->covariance[72];
            const float v_50 = p_8_9 + (0.025f * p_9_9);
            after->covariance[68] = params->variance_step_pitch + ((p_8_8 + (0.025f * p_8_9)) + (0.025f * v_50));
            after->covariance[69] = v_50;
            const float p_9_10 = before->covariance[73];
            const float p_9_11 = before->covariance[74];
            const float v_51 = 0.025f * p_9_11;
            const float v_52 = p_8_11 + v_51;
            after->covariance[70] = (p_8_10 + (0.025f * p_9_10)) + (0.025f * v_52);
            after->covariance[71] = v_52;
            after->covariance[72] = params->variance_step_pitch_rate + p_9_9;
            after->covariance[73] = p_9_10 + v_51;
            after->covariance[74] = p_9_11;
            const float p_10_11 = before->covariance[76];
            const float p_11_11 = before->covariance[77];
            const float v_53 = p_10_11 + (0.025f * p_11_11);
            after->covariance[75] = params->variance_step_yaw + ((before->covariance[75] + (0.025f * p_10_11)) + (0.025f
                * v_53));
            after->covariance[76] = v_53;
            after->covariance[77] = params->variance_step_yaw_rate + p_11_11;
        }

        /* judge, then commit */
        if (!quadrotor_kf_controller_estimator_is_bounded(after->covariance))
        {
            status = quadrotor_kf_controller_estimator_hold_variances(after->covariance);
        }
        if (status >= QUADROTOR_KF_CONTROLLER_OK)
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
                status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
            }
        }
    }
    return status;
}

/* 1014 additions, 1254 multiplications, 12 divisions, 24 negations, 12 selections. */
static quadrotor_kf_controller_status_t quadrotor_kf_controller_estimator_update_pose_core(
    const quadrotor_kf_controller_estimator_state_t *before, quadrotor_kf_controller_estimator_state_t *after,
    const quadrotor_kf_controller_estimator_params_t *params, const float pose[12], const float gate,
    quadrotor_kf_controller_estimator_update_pose_out_t *out)
{
    quadrotor_kf_controller_estimator_rows_t work;
    float spare_covariance[78];
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

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
        status = QUADROTOR_KF_CONTROLLER_BAD_INPUT;
    }
    else
    {
        /* residual[0] = pose[0] - x */
        /* residual[1] = pose[1] - vx */
        /* residual[2] = pose[2] - y */
        /* residual[3] = pose[3] - vy */
        /* residual[4] = pose[4] - z */
        /* residual[5] = pose[5] - vz */
        /* residual[6] = pose[6] - roll */
        /* residual[7] = pose[7] - roll_rate */
        /* residual[8] = pose[8] - pitch */
        /* residual[9] = pose[9] - pitch_rate */
        /* residual[10] = pose[10] - yaw */
        /* residual[11] = pose[11] - yaw_rate */
        const float residual_0 = pose[0] - before->x;
        const float residual_1 = pose[1] - before->vx;
        const float residual_2 = pose[2] - before->y;
        const float residual_3 = pose[3] - before->vy;
        const float residual_4 = pose[4] - before->z;
        const float residual_5 = pose[5] - before->vz;
        const float residual_6 = pose[6] - before->roll;
        const float residual_7 = pose[7] - before->roll_rate;
        const float residual_8 = pose[8] - before->pitch;
        const float residual_9 = pose[9] - before->pitch_rate;
        const float residual_10 = pose[10] - before->yaw;
        const float residual_11 = pose[11] - before->yaw_rate;

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

        /* d = d + K e, P = P - K s K', two rows at a time; measured rows as r K */
        work.delta[0] = 0.0f;
        work.delta[1] = 0.0f;
        work.delta[2] = 0.0f;
        work.delta[3] = 0.0f;
        work.delta[4] = 0.0f;
        work.delta[5] = 0.0f;
        work.delta[6] = 0.0f;
        work.delta[7] = 0.0f;
        work.delta[8] = 0.0f;
        work.delta[9] = 0.0f;
        work.delta[10] = 0.0f;
        work.delta[11] = 0.0f;
        work.nis = 0.0f;
        /* rows 0 and 1 */
        quadrotor_kf_controller_estimator_gain(before->covariance, spare_covariance, &work, &out->innovation[0],
            &params->variance_pose[0], &work.row_variance[0]);
        quadrotor_kf_controller_estimator_place(spare_covariance, &work);
        quadrotor_kf_controller_estimator_downdate(before->covariance, spare_covariance, &work);
        /* rows 2 and 3 */
        quadrotor_kf_controller_estimator_gain(spare_covariance, after->covariance, &work, &out->innovation[2],
            &params->variance_pose[2], &work.row_variance[2]);
        quadrotor_kf_controller_estimator_place(after->covariance, &work);
        quadrotor_kf_controller_estimator_downdate(spare_covariance, after->covariance, &work);
        /* rows 4 and 5 */
        quadrotor_kf_controller_estimator_gain(after->covariance, spare_covariance, &work, &out->innovation[4],
            &params->variance_pose[4], &work.row_variance[4]);
        quadrotor_kf_controller_estimator_place(spare_covariance, &work);
        quadrotor_kf_controller_estimator_downdate(after->covariance, spare_covariance, &work);
        /* rows 6 and 7 */
        quadrotor_kf_controller_estimator_gain(spare_covariance, after->covariance, &work, &out->innovation[6],
            &params->variance_pose[6], &work.row_variance[6]);
        quadrotor_kf_controller_estimator_place(after->covariance, &work);
        quadrotor_kf_controller_estimator_downdate(spare_covariance, after->covariance, &work);
        /* rows 8 and 9 */
        quadrotor_kf_controller_estimator_gain(after->covariance, spare_covariance, &work, &out->innovation[8],
            &params->variance_pose[8], &work.row_variance[8]);
        quadrotor_kf_controller_estimator_place(spare_covariance, &work);
        quadrotor_kf_controller_estimator_downdate(after->covariance, spare_covariance, &work);
        /* rows 10 and 11 */
        quadrotor_kf_controller_estimator_gain(spare_covariance, after->covariance, &work, &out->innovation[10],
            &params->variance_pose[10], &work.row_variance[10]);
        quadrotor_kf_controller_estimator_place(after->covariance, &work);
        quadrotor_kf_controller_estimator_downdate(spare_covariance, after->covariance, &work);

        if (!(((work.row_variance[0] >= 1.0e-20f) == true) && ((work.row_variance[1] >= 1.0e-20f) == true)
              && ((work.row_variance[2] >= 1.0e-20f) == true) && ((work.row_variance[3] >= 1.0e-20f) == true)
              && ((work.row_variance[4] >= 1.0e-20f) == true) && ((work.row_variance[5] >= 1.0e-20f) == true)
              && ((work.row_variance[6] >= 1.0e-20f) == true) && ((work.row_variance[7] >= 1.0e-20f) == true)
              && ((work.row_variance[8] >= 1.0e-20f) == true) && ((work.row_variance[9] >= 1.0e-20f) == true)
              && ((work.row_variance[10] >= 1.0e-20f) == true) && ((work.row_variance[11] >= 1.0e-20f) == true)))
        {
            status = QUADROTOR_KF_CONTROLLER_NOT_POSITIVE;
        }
        else
        {
            if (!(((work.nis >= 0.0f) == true) && ((work.nis <= 1.0e30f) == true)))
            {
                status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
            }
            else
            {
                out->nis = work.nis;

                /* accepted? */
                if ((gate <= 0.0f) || (work.nis <= gate))
                {
                    /* x = x + d */
                    after->x = before->x + work.delta[0];
                    after->vx = before->vx + work.delta[1];
                    after->y = before->y + work.delta[2];
                    after->vy = before->vy + work.delta[3];
                    after->z = before->z + work.delta[4];
                    after->vz = before->vz + work.delta[5];
                    after->roll = before->roll + work.delta[6];
                    after->roll_rate = before->roll_rate + work.delta[7];
                    after->pitch = before->pitch + work.delta[8];
                    after->pitch_rate = before->pitch_rate + work.delta[9];
                    after->yaw = before->yaw + work.delta[10];
                    after->yaw_rate = before->yaw_rate + work.delta[11];
                    after->rejected_pose = 0U;

                    /* judge, then commit */
                    if (!quadrotor_kf_controller_estimator_is_bounded(after->covariance))
                    {
                        status = quadrotor_kf_controller_estimator_hold_variances(after->covariance);
                    }
                    if (status >= QUADROTOR_KF_CONTROLLER_OK)
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
                            status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
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
                    status = quadrotor_kf_controller_higher(status, QUADROTOR_KF_CONTROLLER_GATED);
                }
            }
        }
    }
    return status;
}

/* 78 multiplications. */
static quadrotor_kf_controller_status_t quadrotor_kf_controller_estimator_inflate_core(
    const quadrotor_kf_controller_estimator_state_t *before, quadrotor_kf_controller_estimator_state_t *after,
    const float factor)
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

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
        status = QUADROTOR_KF_CONTROLLER_BAD_INPUT;
    }
    else
    {
        /* P = factor P */
        for (uint32_t i = 0U; i < 78U; i++)
        {
            after->covariance[i] = factor * before->covariance[i];
        }

        /* judge, then commit */
        if (!quadrotor_kf_controller_estimator_is_bounded(after->covariance))
        {
            status = quadrotor_kf_controller_estimator_hold_variances(after->covariance);
        }
    }
    return status;
}

static quadrotor_kf_controller_status_t quadrotor_kf_controller_estimator_step_core(
    const quadrotor_kf_controller_estimator_state_t *before, quadrotor_kf_controller_estimator_state_t *after,
    const quadrotor_kf_controller_estimator_params_t *params, const float rotor_1, const float rotor_2,
    const float rotor_3, const float rotor_4, const bool has_pose, const float pose[12],
    quadrotor_kf_controller_estimator_step_out_t *out)
{
    quadrotor_kf_controller_estimator_state_t work[2];
    quadrotor_kf_controller_estimator_state_t *latest = &work[0];
    quadrotor_kf_controller_estimator_state_t *spare = after;
    quadrotor_kf_controller_status_t status = quadrotor_kf_controller_estimator_predict_core(before, latest, params,
        rotor_1, rotor_2, rotor_3, rotor_4);

    if (status >= QUADROTOR_KF_CONTROLLER_OK)
    {
        /* pose */
        if (has_pose)
        {
            /* pose gated too often in a row: trust it once */
            if ((params->reject_limit > 0U) && (latest->rejected_pose >= params->reject_limit))
            {
                quadrotor_kf_controller_status_t own = quadrotor_kf_controller_estimator_inflate_core(latest, &work[1],
                    params->inflation);
                quadrotor_kf_controller_status_t highest = status;

                if (own >= QUADROTOR_KF_CONTROLLER_OK)
                {
                    highest = quadrotor_kf_controller_higher(highest, own);
                    own = quadrotor_kf_controller_estimator_update_pose_core(&work[1], spare, params, pose, 0.0f,
                        &out->pose);
                }
                out->status_pose = own;
                if (own >= QUADROTOR_KF_CONTROLLER_OK)
                {
                    latest = spare;
                    status = quadrotor_kf_controller_higher(highest, own);
                    status = quadrotor_kf_controller_higher(status, QUADROTOR_KF_CONTROLLER_RECOVERED);
                }
                else
                {
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                        out->pose.innovation[i] = 0.0f;
                    }
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                        out->pose.variance[i] = 0.0f;
                    }
                    out->pose.nis = 0.0f;
                    status = quadrotor_kf_controller_higher(status, QUADROTOR_KF_CONTROLLER_SKIPPED);
                }
            }
            else
            {
                quadrotor_kf_controller_status_t own = quadrotor_kf_controller_estimator_update_pose_core(latest, spare,
                    params, pose, params->gate_pose, &out->pose);

                out->status_pose = own;
                if (own >= QUADROTOR_KF_CONTROLLER_OK)
                {
                    latest = spare;
                    status = quadrotor_kf_controller_higher(status, own);
                }
                else
                {
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                        out->pose.innovation[i] = 0.0f;
                    }
                    for (uint32_t i = 0U; i < 12U; i++)
                    {
                        out->pose.variance[i] = 0.0f;
                    }
                    out->pose.nis = 0.0f;
                    status = quadrotor_kf_controller_higher(status, QUADROTOR_KF_CONTROLLER_SKIPPED);
                }
            }
        }
        else
        {
            for (uint32_t i = 0U; i < 12U; i++)
            {
                out->pose.innovation[i] = 0.0f;
            }
            for (uint32_t i = 0U; i < 12U; i++)
            {
                out->pose.variance[i] = 0.0f;
            }
            out->pose.nis = 0.0f;
            out->status_pose = QUADROTOR_KF_CONTROLLER_OK;
        }
        if (latest != after)
        {
            *after = *latest;
        }
    }
    return status;
}

static quadrotor_kf_controller_status_t quadrotor_kf_controller_feedback_init_core(
    quadrotor_kf_controller_feedback_state_t *after, const quadrotor_kf_controller_feedback_params_t *params)
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

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
        status = QUADROTOR_KF_CONTROLLER_BAD_PARAM;
    }
    return status;
}

/* 60 additions, 48 multiplications. */
static quadrotor_kf_controller_status_t quadrotor_kf_controller_feedback_step_core(
    const quadrotor_kf_controller_feedback_state_t *before, quadrotor_kf_controller_feedback_state_t *after,
    const quadrotor_kf_controller_feedback_params_t *params, const float x, const float vx, const float y,
    const float vy, const float z, const float vz, const float roll, const float roll_rate, const float pitch,
    const float pitch_rate, const float yaw, const float yaw_rate, quadrotor_kf_controller_feedback_step_out_t *out)
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

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
        status = QUADROTOR_KF_CONTROLLER_BAD_INPUT;
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
            status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
        }
        else
        {
            if (!(((out->rotor_2 >= -1000.0f) == true) && ((out->rotor_2 <= 1000.0f) == true)))
            {
                status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
            }
            else
            {
                if (!(((out->rotor_3 >= -1000.0f) == true) && ((out->rotor_3 <= 1000.0f) == true)))
                {
                    status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
                }
                else
                {
                    if (!(((out->rotor_4 >= -1000.0f) == true) && ((out->rotor_4 <= 1000.0f) == true)))
                    {
                        status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
                    }
                }
            }
        }
    }
    return status;
}

static quadrotor_kf_controller_status_t quadrotor_kf_controller_init_core(
    quadrotor_kf_controller_state_t *after, const quadrotor_kf_controller_params_t *params)
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

    if (!(((params->delay_estimator_rotor_1_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_1_0 <= 1000.0f) == true)
          && ((params->delay_estimator_rotor_2_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_2_0 <= 1000.0f) == true)
          && ((params->delay_estimator_rotor_3_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_3_0 <= 1000.0f) == true)
          && ((params->delay_estimator_rotor_4_0 >= -1000.0f) == true)
          && ((params->delay_estimator_rotor_4_0 <= 1000.0f) == true)))
    {
        status = QUADROTOR_KF_CONTROLLER_BAD_PARAM;
    }
    else
    {
        /* estimator: quadrotor_kf, init */
        const quadrotor_kf_controller_status_t status_estimator =
            quadrotor_kf_controller_estimator_init_core(&after->estimator, &params->estimator);
        status = (status_estimator < QUADROTOR_KF_CONTROLLER_OK) ? status_estimator :
            quadrotor_kf_controller_higher(status, status_estimator);
        if (status >= QUADROTOR_KF_CONTROLLER_OK)
        {
            /* feedback: feedback, init */
            const quadrotor_kf_controller_status_t status_feedback =
                quadrotor_kf_controller_feedback_init_core(&after->feedback, &params->feedback);
            status = (status_feedback < QUADROTOR_KF_CONTROLLER_OK) ? status_feedback :
                quadrotor_kf_controller_higher(status, status_feedback);
            if (status >= QUADROTOR_KF_CONTROLLER_OK)
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

static quadrotor_kf_controller_status_t quadrotor_kf_controller_step_core(
    const quadrotor_kf_controller_state_t *before, quadrotor_kf_controller_state_t *after,
    const quadrotor_kf_controller_params_t *params, const bool estimator_has_pose, const float estimator_pose[12],
    quadrotor_kf_controller_step_out_t *out)
{
    quadrotor_kf_controller_status_t status = QUADROTOR_KF_CONTROLLER_OK;

    /* estimator: quadrotor_kf, step */
    const quadrotor_kf_controller_status_t status_estimator =
        quadrotor_kf_controller_estimator_step_core(&before->estimator, &after->estimator, &params->estimator,
        before->delay_estimator_rotor_1, before->delay_estimator_rotor_2, before->delay_estimator_rotor_3,
        before->delay_estimator_rotor_4, estimator_has_pose, estimator_pose, &out->estimator);
    status = (status_estimator < QUADROTOR_KF_CONTROLLER_OK) ? status_estimator : quadrotor_kf_controller_higher(status,
        status_estimator);
    if (status >= QUADROTOR_KF_CONTROLLER_OK)
    {
        /* feedback: feedback, step */
        const quadrotor_kf_controller_status_t status_feedback =
            quadrotor_kf_controller_feedback_step_core(&before->feedback, &after->feedback, &params->feedback,
            after->estimator.x, after->estimator.vx, after->estimator.y, after->estimator.vy, after->estimator.z,
            after->estimator.vz, after->estimator.roll, after->estimator.roll_rate, after->estimator.pitch,
            after->estimator.pitch_rate, after->estimator.yaw, after->estimator.yaw_rate, &out->feedback);
        status = (status_feedback < QUADROTOR_KF_CONTROLLER_OK) ? status_feedback :
            quadrotor_kf_controller_higher(status, status_feedback);
        if (status >= QUADROTOR_KF_CONTROLLER_OK)
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
                status = QUADROTOR_KF_CONTROLLER_OVERFLOW;
            }
        }
    }
    return status;
}

quadrotor_kf_controller_status_t quadrotor_kf_controller_init(quadrotor_kf_controller_state_t *state,
                                                              const quadrotor_kf_controller_params_t *params)
{
    quadrotor_kf_controller_state_t after;
    const quadrotor_kf_controller_status_t status = quadrotor_kf_controller_init_core(&after, params);

    if (status >= QUADROTOR_KF_CONTROLLER_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_kf_controller_status_t quadrotor_kf_controller_step(quadrotor_kf_controller_state_t *state,
                                                              const quadrotor_kf_controller_params_t *params,
                                                              const quadrotor_kf_controller_step_in_t *in,
                                                              quadrotor_kf_controller_step_out_t *out)
{
    quadrotor_kf_controller_state_t after;
    quadrotor_kf_controller_step_out_t answer;
    const quadrotor_kf_controller_status_t status = quadrotor_kf_controller_step_core(state, &after, params,
        in->estimator_has_pose, in->estimator_pose, &answer);

    if (status >= QUADROTOR_KF_CONTROLLER_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

/* The hash of the model, as in the header. */
const char *quadrotor_kf_controller_model(void)
{
    return "32695685";
}

/* A sentence for a status. */
const char *quadrotor_kf_controller_status_text(quadrotor_kf_controller_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case QUADROTOR_KF_CONTROLLER_OK:
            text = "ok";
            break;
        case QUADROTOR_KF_CONTROLLER_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case QUADROTOR_KF_CONTROLLER_CLAMPED:
            text = "a value (a variance, a command) was held at its limit";
            break;
        case QUADROTOR_KF_CONTROLLER_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case QUADROTOR_KF_CONTROLLER_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case QUADROTOR_KF_CONTROLLER_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case QUADROTOR_KF_CONTROLLER_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case QUADROTOR_KF_CONTROLLER_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case QUADROTOR_KF_CONTROLLER_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
