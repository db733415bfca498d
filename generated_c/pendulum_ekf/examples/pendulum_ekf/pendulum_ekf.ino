/* How to call pendulum_ekf from a sketch. Written by plantc 0.1.0 from model 65098682.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <pendulum_ekf.h>

static const pendulum_ekf_params_t params = PENDULUM_EKF_PARAMS_DEFAULT;
static pendulum_ekf_state_t state;

void setup()
{
    Serial.begin(115200);
    const pendulum_ekf_status_t status = pendulum_ekf_init(&state, &params);
    Serial.println(pendulum_ekf_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    pendulum_ekf_step_in_t in = {0.0f, 0.00001f, false, 0.0f};
    pendulum_ekf_step_out_t out;
    const pendulum_ekf_status_t status = pendulum_ekf_step(&state, &params, &in, &out);

    if (status < PENDULUM_EKF_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(pendulum_ekf_status_text(status));
    }
    delay(1000);
}
