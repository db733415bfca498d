/* How to call quadrotor_ud: an example to copy from. Written by plantc 0.1.0 from model f4dfb1d1.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include "quadrotor_ud.h"

#include <stdio.h>

int main(void)
{
    const quadrotor_ud_params_t params = QUADROTOR_UD_PARAMS_DEFAULT;
    quadrotor_ud_state_t state;
    quadrotor_ud_step_in_t in = {0.0f, 0.0f, 0.0f, 0.0f, false, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}};
    quadrotor_ud_step_out_t out;
    quadrotor_ud_status_t status = quadrotor_ud_init(&state, &params);

    (void)printf("model %s, init: %s\n", quadrotor_ud_model(), quadrotor_ud_status_text(status));
    for (int k = 0; k < 10; k++)
    {
        /* fill `in` from the sensors here */
        status = quadrotor_ud_step(&state, &params, &in, &out);
        if (status < QUADROTOR_UD_OK)
        {
            /* refused: the state is as it was before the call */
            (void)printf("step %d: %s\n", k, quadrotor_ud_status_text(status));
        }
    }
    (void)printf("last status: %s\n", quadrotor_ud_status_text(status));
    return (status < QUADROTOR_UD_OK) ? 1 : 0;
}
