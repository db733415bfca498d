/* How to call quadrotor_ekf from a sketch. Written by plantc 0.1.0 from model 507719b3.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include <quadrotor_ekf.h>

static const quadrotor_ekf_params_t params = QUADROTOR_EKF_PARAMS_DEFAULT;
static quadrotor_ekf_state_t state;

void setup()
{
    Serial.begin(115200);
    const quadrotor_ekf_status_t status = quadrotor_ekf_init(&state, &params);
    Serial.println(quadrotor_ekf_status_text(status));
}

void loop()
{
    /* fill `in` from the sensors here */
    quadrotor_ekf_step_in_t in = {0.0, 0.0, 0.0, 0.0, false, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
    quadrotor_ekf_step_out_t out;
    const quadrotor_ekf_status_t status = quadrotor_ekf_step(&state, &params, &in, &out);

    if (status < QUADROTOR_EKF_OK)
    {
        /* refused: the state is as it was before the call */
        Serial.println(quadrotor_ekf_status_text(status));
    }
    delay(1000);
}
