/* How to call quadrotor_regulator from a sketch. Written by plantc 0.1.0 from model 982acaf4.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <quadrotor_regulator.h>

static const quadrotor_regulator_params_t params = QUADROTOR_REGULATOR_PARAMS_DEFAULT;
static quadrotor_regulator_state_t state;

void setup()
{
    Serial.begin(115200);
    const quadrotor_regulator_status_t status = quadrotor_regulator_init(&state, &params);
    Serial.println(quadrotor_regulator_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    quadrotor_regulator_step_in_t in = {false, 0.0f, false, 0.0f, false, 0.0f, false, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    quadrotor_regulator_step_out_t out;
    const quadrotor_regulator_status_t status = quadrotor_regulator_step(&state, &params, &in, &out);

    if (status < QUADROTOR_REGULATOR_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(quadrotor_regulator_status_text(status));
    }
    delay(1000);
}
