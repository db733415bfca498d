/* quadrotor_high_gain_regulator: see quadrotor_high_gain_regulator.h. Written by plantc 0.1.0 from model 0e531f3d. */
#include "quadrotor_high_gain_regulator.h"

#ifdef __FAST_MATH__
#error "quadrotor_high_gain_regulator checks for NaN and infinity: do not build it with -ffast-math"
#endif

/* The higher of two statuses: what a call returns where several things were degraded. */
static quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_higher(quadrotor_high_gain_regulator_status_t first, quadrotor_high_gain_regulator_status_t second)
{
    return (first > second) ? first : second;
}

static quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_generator_x_init_core(
    quadrotor_high_gain_regulator_generator_x_state_t *after,
    const quadrotor_high_gain_regulator_generator_x_params_t *params)
{
    quadrotor_high_gain_regulator_status_t status = QUADROTOR_HIGH_GAIN_REGULATOR_OK;

    if (!(((params->observer_reading_0[0] >= -1000000.0f) == true)
          && ((params->observer_reading_0[0] <= 1000000.0f) == true)
          && ((params->observer_reading_0[1] >= -1000000.0f) == true)
          && ((params->observer_reading_0[1] <= 1000000.0f) == true) && ((params->gain_reading[0] >= -1.0e12f) == true)
          && ((params->gain_reading[0] <= 1.0e12f) == true) && ((params->gain_reading[1] >= -1.0e12f) == true)
          && ((params->gain_reading[1] <= 1.0e12f) == true)))
    {
        status = QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM;
    }
    else
    {
        after->observer_reading[0] = params->observer_reading_0[0];
        after->observer_reading[1] = params->observer_reading_0[1];
    }
    return status;
}

/* 5 additions, 4 multiplications. */
static quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_generator_x_step_core(
    const quadrotor_high_gain_regulator_generator_x_state_t *before,
    quadrotor_high_gain_regulator_generator_x_state_t *after,
    const quadrotor_high_gain_regulator_generator_x_params_t *params, const bool has_reading, const float reading,
    quadrotor_high_gain_regulator_generator_x_step_out_t *out)
{
    quadrotor_high_gain_regulator_status_t status = QUADROTOR_HIGH_GAIN_REGULATOR_OK;

    out->w_reading[0] = before->observer_reading[0];
    out->w_reading[1] = before->observer_reading[1];

    /* reading */
    if (has_reading)
    {
        if (!(((reading >= -10.0f) == true) && ((reading <= 10.0f) == true)))
        {
            status = QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT;
        }
        else
        {
            /* w = F w + gain (reading - w[0]) */
            const float observer_reading_0 = before->observer_reading[0];
            const float observer_reading_1 = before->observer_reading[1];
            const float v = reading - observer_reading_0;
            after->observer_reading[0] = (observer_reading_0 + (observer_reading_1 * 0.02f)) + (params->gain_reading[0]
                * v);
            after->observer_reading[1] = observer_reading_1 + (params->gain_reading[1] * v);
        }
    }
    else
    {
        /* w = F w */
        const float observer_reading_1 = before->observer_reading[1];
        after->observer_reading[0] = before->observer_reading[0] + (observer_reading_1 * 0.02f);
        after->observer_reading[1] = observer_reading_1;
    }
    if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
    {
        if (!(((after->observer_reading[0] >= -1000000.0f) == true)
              && ((after->observer_reading[0] <= 1000000.0f) == true)
              && ((after->observer_reading[1] >= -1000000.0f) == true)
              && ((after->observer_reading[1] <= 1000000.0f) == true)))
        {
            status = QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW;
        }
    }
    return status;
}

static quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_feedback_init_core(
    quadrotor_high_gain_regulator_feedback_state_t *after,
    const quadrotor_high_gain_regulator_feedback_params_t *params)
{
    quadrotor_high_gain_regulator_status_t status = QUADROTOR_HIGH_GAIN_REGULATOR_OK;

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
        status = QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM;
    }
    return status;
}

/* 66 additions, 12 multiplications, 1 negation. */
static quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_feedback_step_core(
    const quadrotor_high_gain_regulator_feedback_state_t *before, quadrotor_high_gain_regulator_feedback_state_t *after,
    const quadrotor_high_gain_regulator_feedback_params_t *params, const float x, const float vx, const float y,
    const float vy, const float z, const float vz, const float roll, const float roll_rate, const float pitch,
    const float pitch_rate, const float yaw, const float yaw_rate, const float w_x[2], const float w_y[2],
    const float w_z[2], const float w_yaw[2], quadrotor_high_gain_regulator_feedback_step_out_t *out)
{
    quadrotor_high_gain_regulator_status_t status = QUADROTOR_HIGH_GAIN_REGULATOR_OK;

    after->unused = 0U;
    (void)before;
    if (!(((x >= -10000.0f) == true) && ((x <= 10000.0f) == true) && ((vx >= -10000.0f) == true)
          && ((vx <= 10000.0f) == true) && ((y >= -10000.0f) == true) && ((y <= 10000.0f) == true)
          && ((vy >= -10000.0f) == true) && ((vy <= 10000.0f) == true) && ((z >= -10000.0f) == true)
          && ((z <= 10000.0f) == true) && ((vz >= -10000.0f) == true) && ((vz <= 10000.0f) == true)
          && ((roll >= -30.0f) == true) && ((roll <= 30.0f) == true) && ((roll_rate >= -1000.0f) == true)
          && ((roll_rate <= 1000.0f) == true) && ((pitch >= -30.0f) == true) && ((pitch <= 30.0f) == true)
          && ((pitch_rate >= -1000.0f) == true) && ((pitch_rate <= 1000.0f) == true) && ((yaw >= -30.0f) == true)
          && ((yaw <= 30.0f) == true) && ((yaw_rate >= -1000.0f) == true) && ((yaw_rate <= 1000.0f) == true)
          && ((w_x[0] >= -1000000.0f) == true) && ((w_x[0] <= 1000000.0f) == true) && ((w_x[1] >= -1000000.0f) == true)
          && ((w_x[1] <= 1000000.0f) == true) && ((w_y[0] >= -1000000.0f) == true) && ((w_y[0] <= 1000000.0f) == true)
          && ((w_y[1] >= -1000000.0f) == true) && ((w_y[1] <= 1000000.0f) == true) && ((w_z[0] >= -1000000.0f) == true)
          && ((w_z[0] <= 1000000.0f) == true) && ((w_z[1] >= -1000000.0f) == true) && ((w_z[1] <= 1000000.0f) == true)
          && ((w_yaw[0] >= -1000000.0f) == true) && ((w_yaw[0] <= 1000000.0f) == true)
          && ((w_yaw[1] >= -1000000.0f) == true) && ((w_yaw[1] <= 1000000.0f) == true)))
    {
        status = QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT;
    }
    else
    {
        /* rotor_1 = rotor_1 - (-4.13564904 (x - params.x - w_x[0]) + -6.44956949 (vx - params.vx - w_x[1]) +
         * 4.13564904 (y - params.y - w_y[0]) + 6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z -
         * w_z[0]) + 11.5275171 (vz - params.vz - w_z[1]) + -28.4171267 (roll - params.roll) + -6.32217889 (roll_rate
         * - params.roll_rate) + -28.4171267 (pitch - params.pitch) + -6.32217889 (pitch_rate - params.pitch_rate) +
         * 4.93424116 (yaw - params.yaw - w_yaw[0]) + 10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        /* rotor_2 = rotor_2 - (4.13564904 (x - params.x - w_x[0]) + 6.44956949 (vx - params.vx - w_x[1]) +
         * 4.13564904 (y - params.y - w_y[0]) + 6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z -
         * w_z[0]) + 11.5275171 (vz - params.vz - w_z[1]) + -28.4171267 (roll - params.roll) + -6.32217889 (roll_rate
         * - params.roll_rate) + 28.4171267 (pitch - params.pitch) + 6.32217889 (pitch_rate - params.pitch_rate) +
         * -4.93424116 (yaw - params.yaw - w_yaw[0]) + -10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        /* rotor_3 = rotor_3 - (4.13564904 (x - params.x - w_x[0]) + 6.44956949 (vx - params.vx - w_x[1]) +
         * -4.13564904 (y - params.y - w_y[0]) + -6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z -
         * w_z[0]) + 11.5275171 (vz - params.vz - w_z[1]) + 28.4171267 (roll - params.roll) + 6.32217889 (roll_rate -
         * params.roll_rate) + 28.4171267 (pitch - params.pitch) + 6.32217889 (pitch_rate - params.pitch_rate) +
         * 4.93424116 (yaw - params.yaw - w_yaw[0]) + 10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        /* rotor_4 = rotor_4 - (-4.13564904 (x - params.x - w_x[0]) + -6.44956949 (vx - params.vx - w_x[1]) +
         * -4.13564904 (y - params.y - w_y[0]) + -6.44956949 (vy - params.vy - w_y[1]) + 4.9470137 (z - params.z -
         * w_z[0]) + 11.5275171 (vz - params.vz - w_z[1]) + 28.4171267 (roll - params.roll) + 6.32217889 (roll_rate -
         * params.roll_rate) + -28.4171267 (pitch - params.pitch) + -6.32217889 (pitch_rate - params.pitch_rate) +
         * -4.93424116 (yaw - params.yaw - w_yaw[0]) + -10.0097342 (yaw_rate - params.yaw_rate - w_yaw[1])) */
        const float v = ((x - params->x) - w_x[0]) * 4.135649f;
        const float v_2 = ((vx - params->vx) - w_x[1]) * 6.4495697f;
        const float v_3 = (-v) - v_2;
        const float v_4 = 4.135649f * ((y - params->y) - w_y[0]);
        const float v_5 = 6.4495697f * ((vy - params->vy) - w_y[1]);
        const float v_6 = 4.947014f * ((z - params->z) - w_z[0]);
        const float v_7 = 11.527517f * ((vz - params->vz) - w_z[1]);
        const float v_8 = (roll - params->roll) * 28.417128f;
        const float v_9 = (roll_rate - params->roll_rate) * 6.322179f;
        const float v_10 = 28.417128f * (pitch - params->pitch);
        const float v_11 = 6.322179f * (pitch_rate - params->pitch_rate);
        const float v_12 = 4.9342413f * ((yaw - params->yaw) - w_yaw[0]);
        const float v_13 = 10.009734f * ((yaw_rate - params->yaw_rate) - w_yaw[1]);
        const float v_14 = (((((((((v_3 + v_4) + v_5) + v_6) + v_7) - v_8) - v_9) - v_10) - v_11) + v_12) + v_13;
        out->rotor_1 = params->rotor_1 - v_14;
        const float v_15 = v + v_2;
        const float v_16 = ((v_11 + (v_10 + (((v_7 + (v_6 + (v_5 + (v_4 + v_15)))) - v_8) - v_9))) - v_12) - v_13;
        out->rotor_2 = params->rotor_2 - v_16;
        const float v_17 = v_13 + (v_12 + (v_11 + (v_10 + (v_9 + (v_8 + (v_7 + (v_6 + ((v_15 - v_4) - v_5))))))));
        out->rotor_3 = params->rotor_3 - v_17;
        const float v_18 = ((((v_9 + (v_8 + (v_7 + (v_6 + ((v_3 - v_4) - v_5))))) - v_10) - v_11) - v_12) - v_13;
        out->rotor_4 = params->rotor_4 - v_18;

        if (!(((out->rotor_1 >= -10000.0f) == true) && ((out->rotor_1 <= 10000.0f) == true)))
        {
            status = QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW;
        }
        else
        {
            if (!(((out->rotor_2 >= -10000.0f) == true) && ((out->rotor_2 <= 10000.0f) == true)))
            {
                status = QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW;
            }
            else
            {
                if (!(((out->rotor_3 >= -10000.0f) == true) && ((out->rotor_3 <= 10000.0f) == true)))
                {
                    status = QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW;
                }
                else
                {
                    if (!(((out->rotor_4 >= -10000.0f) == true) && ((out->rotor_4 <= 10000.0f) == true)))
                    {
                        status = QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW;
                    }
                }
            }
        }
    }
    return status;
}

static quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_init_core(
    quadrotor_high_gain_regulator_state_t *after, const quadrotor_high_gain_regulator_params_t *params)
{
    quadrotor_high_gain_regulator_status_t status = QUADROTOR_HIGH_GAIN_REGULATOR_OK;

    /* generator_x: generator, init */
    const quadrotor_high_gain_regulator_status_t status_generator_x =
        quadrotor_high_gain_regulator_generator_x_init_core(&after->generator_x, &params->generator_x);
    status = (status_generator_x < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_x :
        quadrotor_high_gain_regulator_higher(status, status_generator_x);
    if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
    {
        /* generator_y: generator, init */
        const quadrotor_high_gain_regulator_status_t status_generator_y =
            quadrotor_high_gain_regulator_generator_x_init_core(&after->generator_y, &params->generator_y);
        status = (status_generator_y < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_y :
            quadrotor_high_gain_regulator_higher(status, status_generator_y);
        if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
        {
            /* generator_z: generator, init */
            const quadrotor_high_gain_regulator_status_t status_generator_z =
                quadrotor_high_gain_regulator_generator_x_init_core(&after->generator_z, &params->generator_z);
            status = (status_generator_z < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_z :
                quadrotor_high_gain_regulator_higher(status, status_generator_z);
            if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
            {
                /* generator_yaw: generator, init */
                const quadrotor_high_gain_regulator_status_t status_generator_yaw =
                    quadrotor_high_gain_regulator_generator_x_init_core(&after->generator_yaw, &params->generator_yaw);
                status = (status_generator_yaw < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_yaw :
                    quadrotor_high_gain_regulator_higher(status, status_generator_yaw);
                if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
                {
                    /* feedback: quadrotor_feedback, init */
                    const quadrotor_high_gain_regulator_status_t status_feedback =
                        quadrotor_high_gain_regulator_feedback_init_core(&after->feedback, &params->feedback);
                    status = (status_feedback < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_feedback :
                        quadrotor_high_gain_regulator_higher(status, status_feedback);
                }
            }
        }
    }
    return status;
}

static quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_step_core(
    const quadrotor_high_gain_regulator_state_t *before, quadrotor_high_gain_regulator_state_t *after,
    const quadrotor_high_gain_regulator_params_t *params, const bool generator_x_has_reading,
    const float generator_x_reading, const bool generator_y_has_reading, const float generator_y_reading,
    const bool generator_z_has_reading, const float generator_z_reading, const bool generator_yaw_has_reading,
    const float generator_yaw_reading, const float feedback_x, const float feedback_vx, const float feedback_y,
    const float feedback_vy, const float feedback_z, const float feedback_vz, const float feedback_roll,
    const float feedback_roll_rate, const float feedback_pitch, const float feedback_pitch_rate,
    const float feedback_yaw, const float feedback_yaw_rate, quadrotor_high_gain_regulator_step_out_t *out)
{
    quadrotor_high_gain_regulator_status_t status = QUADROTOR_HIGH_GAIN_REGULATOR_OK;

    /* generator_x: generator, step */
    const quadrotor_high_gain_regulator_status_t status_generator_x =
        quadrotor_high_gain_regulator_generator_x_step_core(&before->generator_x, &after->generator_x,
        &params->generator_x, generator_x_has_reading, generator_x_reading, &out->generator_x);
    status = (status_generator_x < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_x :
        quadrotor_high_gain_regulator_higher(status, status_generator_x);
    if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
    {
        /* generator_y: generator, step */
        const quadrotor_high_gain_regulator_status_t status_generator_y =
            quadrotor_high_gain_regulator_generator_x_step_core(&before->generator_y, &after->generator_y,
            &params->generator_y, generator_y_has_reading, generator_y_reading, &out->generator_y);
        status = (status_generator_y < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_y :
            quadrotor_high_gain_regulator_higher(status, status_generator_y);
        if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
        {
            /* generator_z: generator, step */
            const quadrotor_high_gain_regulator_status_t status_generator_z =
                quadrotor_high_gain_regulator_generator_x_step_core(&before->generator_z, &after->generator_z,
                &params->generator_z, generator_z_has_reading, generator_z_reading, &out->generator_z);
            status = (status_generator_z < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_z :
                quadrotor_high_gain_regulator_higher(status, status_generator_z);
            if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
            {
                /* generator_yaw: generator, step */
                const quadrotor_high_gain_regulator_status_t status_generator_yaw =
                    quadrotor_high_gain_regulator_generator_x_step_core(&before->generator_yaw, &after->generator_yaw,
                    &params->generator_yaw, generator_yaw_has_reading, generator_yaw_reading, &out->generator_yaw);
                status = (status_generator_yaw < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_generator_yaw :
                    quadrotor_high_gain_regulator_higher(status, status_generator_yaw);
                if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
                {
                    /* feedback: quadrotor_feedback, step */
                    const quadrotor_high_gain_regulator_status_t status_feedback =
                        quadrotor_high_gain_regulator_feedback_step_core(&before->feedback, &after->feedback,
                        &params->feedback, feedback_x, feedback_vx, feedback_y, feedback_vy, feedback_z, feedback_vz,
                        feedback_roll, feedback_roll_rate, feedback_pitch, feedback_pitch_rate, feedback_yaw,
                        feedback_yaw_rate, out->generator_x.w_reading, out->generator_y.w_reading,
                        out->generator_z.w_reading, out->generator_yaw.w_reading, &out->feedback);
                    status = (status_feedback < QUADROTOR_HIGH_GAIN_REGULATOR_OK) ? status_feedback :
                        quadrotor_high_gain_regulator_higher(status, status_feedback);
                }
            }
        }
    }
    return status;
}

quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_init(
    quadrotor_high_gain_regulator_state_t *state, const quadrotor_high_gain_regulator_params_t *params)
{
    quadrotor_high_gain_regulator_state_t after;
    const quadrotor_high_gain_regulator_status_t status = quadrotor_high_gain_regulator_init_core(&after, params);

    if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
    {
        *state = after;
    }
    return status;
}

quadrotor_high_gain_regulator_status_t quadrotor_high_gain_regulator_step(
    quadrotor_high_gain_regulator_state_t *state, const quadrotor_high_gain_regulator_params_t *params,
    const quadrotor_high_gain_regulator_step_in_t *in, quadrotor_high_gain_regulator_step_out_t *out)
{
    quadrotor_high_gain_regulator_state_t after;
    quadrotor_high_gain_regulator_step_out_t answer;
    const quadrotor_high_gain_regulator_status_t status = quadrotor_high_gain_regulator_step_core(state, &after, params,
        in->generator_x_has_reading, in->generator_x_reading, in->generator_y_has_reading, in->generator_y_reading,
        in->generator_z_has_reading, in->generator_z_reading, in->generator_yaw_has_reading, in->generator_yaw_reading,
        in->feedback_x, in->feedback_vx, in->feedback_y, in->feedback_vy, in->feedback_z, in->feedback_vz,
        in->feedback_roll, in->feedback_roll_rate, in->feedback_pitch, in->feedback_pitch_rate, in->feedback_yaw,
        in->feedback_yaw_rate, &answer);

    if (status >= QUADROTOR_HIGH_GAIN_REGULATOR_OK)
    {
        *state = after;
        *out = answer;
    }
    return status;
}

/* The hash of the model, as in the header. */
const char *quadrotor_high_gain_regulator_model(void)
{
    return "0e531f3d";
}

/* A sentence for a status. */
const char *quadrotor_high_gain_regulator_status_text(quadrotor_high_gain_regulator_status_t status)
{
    const char *text = "unknown status";

    switch (status)
    {
        case QUADROTOR_HIGH_GAIN_REGULATOR_OK:
            text = "ok";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_GATED:
            text = "innovation beyond the gate: reading not used";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_CLAMPED:
            text = "a value (a variance, a command) was held at its limit";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_SKIPPED:
            text = "a sensor was refused and skipped: see its own status";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_RECOVERED:
            text = "gated too often in a row: P inflated, reading taken without gate";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT:
            text = "an input is outside its range, or not a number";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM:
            text = "a parameter is outside its range, or not a number";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_NOT_POSITIVE:
            text = "a variance would not be positive";
            break;
        case QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW:
            text = "the result would leave its range";
            break;
        default:
            /* text says so already */
            break;
    }
    return text;
}
