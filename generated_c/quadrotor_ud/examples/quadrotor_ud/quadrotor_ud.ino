/* How to call quadrotor_ud from a sketch. Written by plantc 0.1.0 from model f4dfb1d1.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <quadrotor_ud.h>

static const quadrotor_ud_params_t params = QUADROTOR_UD_PARAMS_DEFAULT;
static quadrotor_ud_state_t state;

void setup()
{
    Serial.begin(115200);
    const quadrotor_ud_status_t status = quadrotor_ud_init(&state, &params);
    Serial.println(quadrotor_ud_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    quadrotor_ud_step_in_t in = {0.0f, 0.0f, 0.0f, 0.0f, false, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}};
    quadrotor_ud_step_out_t out;
    const quadrotor_ud_status_t status = quadrotor_ud_step(&state, &params, &in, &out);

    if (status < QUADROTOR_UD_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(quadrotor_ud_status_text(status));
    }
    delay(1000);
}
