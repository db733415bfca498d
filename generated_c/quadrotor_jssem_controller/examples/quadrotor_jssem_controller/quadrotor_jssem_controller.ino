/* How to call quadrotor_jssem_controller from a sketch. Written by plantc 0.1.0 from model b00f45d0.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <quadrotor_jssem_controller.h>

static const quadrotor_jssem_controller_params_t params = QUADROTOR_JSSEM_CONTROLLER_PARAMS_DEFAULT;
static quadrotor_jssem_controller_state_t state;

void setup()
{
    Serial.begin(115200);
    const quadrotor_jssem_controller_status_t status = quadrotor_jssem_controller_init(&state, &params);
    Serial.println(quadrotor_jssem_controller_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    quadrotor_jssem_controller_step_in_t in = {false, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}};
    quadrotor_jssem_controller_step_out_t out;
    const quadrotor_jssem_controller_status_t status = quadrotor_jssem_controller_step(&state, &params, &in, &out);

    if (status < QUADROTOR_JSSEM_CONTROLLER_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(quadrotor_jssem_controller_status_text(status));
    }
    delay(1000);
}
