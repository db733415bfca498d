/* How to call quadrotor_kf from a sketch. Written by plantc 0.1.0 from model 1b4628c2.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <quadrotor_kf.h>

static const quadrotor_kf_params_t params = QUADROTOR_KF_PARAMS_DEFAULT;
static quadrotor_kf_state_t state;

void setup()
{
    Serial.begin(115200);
    const quadrotor_kf_status_t status = quadrotor_kf_init(&state, &params);
    Serial.println(quadrotor_kf_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    quadrotor_kf_step_in_t in = {0.0, 0.0, 0.0, 0.0, false, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
    quadrotor_kf_step_out_t out;
    const quadrotor_kf_status_t status = quadrotor_kf_step(&state, &params, &in, &out);

    if (status < QUADROTOR_KF_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(quadrotor_kf_status_text(status));
    }
    delay(1000);
}
