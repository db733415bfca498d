/* How to call attitude_ekf from a sketch. Written by plantc 0.1.0 from model dc394edc.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <attitude_ekf.h>

static const attitude_ekf_params_t params = ATTITUDE_EKF_PARAMS_DEFAULT;
static attitude_ekf_state_t state;

void setup()
{
    Serial.begin(115200);
    const attitude_ekf_status_t status = attitude_ekf_init(&state, &params);
    Serial.println(attitude_ekf_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    attitude_ekf_step_in_t in = {{0.0f, 0.0f, 0.0f}, 0.0001f, false, {0.0f, 0.0f, 0.0f}, false, {0.0f, 0.0f, 0.0f}};
    attitude_ekf_step_out_t out;
    const attitude_ekf_status_t status = attitude_ekf_step(&state, &params, &in, &out);

    if (status < ATTITUDE_EKF_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(attitude_ekf_status_text(status));
    }
    delay(1000);
}
