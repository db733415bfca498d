/* How to call quadrotor_jssem_controller: an example to copy from. Written by plantc 0.1.0 from model b00f45d0.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include "quadrotor_jssem_controller.h"

#include <stdio.h>

int main(void)
{
    const quadrotor_jssem_controller_params_t params = QUADROTOR_JSSEM_CONTROLLER_PARAMS_DEFAULT;
    quadrotor_jssem_controller_state_t state;
    quadrotor_jssem_controller_step_in_t in = {false, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}};
    quadrotor_jssem_controller_step_out_t out;
    quadrotor_jssem_controller_status_t status = quadrotor_jssem_controller_init(&state, &params);

    (void)printf("model %s, init: %s\n", quadrotor_jssem_controller_model(),
     quadrotor_jssem_controller_status_text(status));
    for (int k = 0; k < 10; k++)
    {
        /* fill `in` from the sensors here */
        status = quadrotor_jssem_controller_step(&state, &params, &in, &out);
        if (status < QUADROTOR_JSSEM_CONTROLLER_OK)
        {
            /* refused: the state is as it was before the call */
            (void)printf("step %d: %s\n", k, quadrotor_jssem_controller_status_text(status));
        }
    }
    (void)printf("last status: %s\n", quadrotor_jssem_controller_status_text(status));
    return (status < QUADROTOR_JSSEM_CONTROLLER_OK) ? 1 : 0;
}
