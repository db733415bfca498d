/* How to call pendulum_ekf: an example to copy from. Written by plantc 0.1.0 from model 65098682.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include "pendulum_ekf.h"

#include <stdio.h>

int main(void)
{
    const pendulum_ekf_params_t params = PENDULUM_EKF_PARAMS_DEFAULT;
    pendulum_ekf_state_t state;
    pendulum_ekf_step_in_t in = {0.0f, 0.00001f, false, 0.0f};
    pendulum_ekf_step_out_t out;
    pendulum_ekf_status_t status = pendulum_ekf_init(&state, &params);

    (void)printf("model %s, init: %s\n", pendulum_ekf_model(), pendulum_ekf_status_text(status));
    for (int k = 0; k < 10; k++)
    {
        /* fill `in` from the sensors here */
        status = pendulum_ekf_step(&state, &params, &in, &out);
        if (status < PENDULUM_EKF_OK)
        {
            /* refused: the state is as it was before the call */
            (void)printf("step %d: %s\n", k, pendulum_ekf_status_text(status));
        }
    }
    (void)printf("last status: %s\n", pendulum_ekf_status_text(status));
    return (status < PENDULUM_EKF_OK) ? 1 : 0;
}
