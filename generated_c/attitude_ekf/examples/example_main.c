/* How to call attitude_ekf: an example to copy from. Written by plantc 0.1.0 from model dc394edc.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include "attitude_ekf.h"

#include <stdio.h>

int main(void)
{
    const attitude_ekf_params_t params = ATTITUDE_EKF_PARAMS_DEFAULT;
    attitude_ekf_state_t state;
    attitude_ekf_step_in_t in = {{0.0f, 0.0f, 0.0f}, 0.0001f, false, {0.0f, 0.0f, 0.0f}, false, {0.0f, 0.0f, 0.0f}};
    attitude_ekf_step_out_t out;
    attitude_ekf_status_t status = attitude_ekf_init(&state, &params);

    (void)printf("model %s, init: %s\n", attitude_ekf_model(), attitude_ekf_status_text(status));
    for (int k = 0; k < 10; k++)
    {
        /* fill `in` from the sensors here */
        status = attitude_ekf_step(&state, &params, &in, &out);
        if (status < ATTITUDE_EKF_OK)
        {
            /* refused: the state is as it was before the call */
            (void)printf("step %d: %s\n", k, attitude_ekf_status_text(status));
        }
    }
    (void)printf("last status: %s\n", attitude_ekf_status_text(status));
    return (status < ATTITUDE_EKF_OK) ? 1 : 0;
}
