/* How to call quadrotor_jsse_controller from a sketch. Written by plantc 0.1.0 from model 3848e263.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <quadrotor_jsse_controller.h>

static const quadrotor_jsse_controller_params_t params = QUADROTOR_JSSE_CONTROLLER_PARAMS_DEFAULT;
static quadrotor_jsse_controller_state_t state;

void setup()
{
    Serial.begin(115200);
    const quadrotor_jsse_controller_status_t status = quadrotor_jsse_controller_init(&state, &params);
    Serial.println(quadrotor_jsse_controller_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    quadrotor_jsse_controller_step_in_t in = {false, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}};
    quadrotor_jsse_controller_step_out_t out;
    const quadrotor_jsse_controller_status_t status = quadrotor_jsse_controller_step(&state, &params, &in, &out);

    if (status < QUADROTOR_JSSE_CONTROLLER_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(quadrotor_jsse_controller_status_text(status));
    }
    delay(1000);
}
