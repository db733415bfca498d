/* How to call quadrotor_steady_regulator: an example to copy from. Written by plantc 0.1.0 from model 16afd8e2.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include "quadrotor_steady_regulator.h"

#include <stdio.h>

int main(void)
{
    const quadrotor_steady_regulator_params_t params = QUADROTOR_STEADY_REGULATOR_PARAMS_DEFAULT;
    quadrotor_steady_regulator_state_t state;
    quadrotor_steady_regulator_step_in_t in = {false, 0.0f, false, 0.0f, false, 0.0f, false, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    quadrotor_steady_regulator_step_out_t out;
    quadrotor_steady_regulator_status_t status = quadrotor_steady_regulator_init(&state, &params);

    (void)printf("model %s, init: %s\n", quadrotor_steady_regulator_model(),
     quadrotor_steady_regulator_status_text(status));
    for (int k = 0; k < 10; k++)
    {
        /* fill `in` from the sensors here */
        status = quadrotor_steady_regulator_step(&state, &params, &in, &out);
        if (status < QUADROTOR_STEADY_REGULATOR_OK)
        {
            /* refused: the state is as it was before the call */
            (void)printf("step %d: %s\n", k, quadrotor_steady_regulator_status_text(status));
        }
    }
    (void)printf("last status: %s\n", quadrotor_steady_regulator_status_text(status));
    return (status < QUADROTOR_STEADY_REGULATOR_OK) ? 1 : 0;
}
