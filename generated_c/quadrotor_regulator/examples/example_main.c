/* How to call quadrotor_regulator: an example to copy from. Written by plantc 0.1.0 from model 982acaf4.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include "quadrotor_regulator.h"

#include <stdio.h>

int main(void)
{
    const quadrotor_regulator_params_t params = QUADROTOR_REGULATOR_PARAMS_DEFAULT;
    quadrotor_regulator_state_t state;
    quadrotor_regulator_step_in_t in = {false, 0.0f, false, 0.0f, false, 0.0f, false, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    quadrotor_regulator_step_out_t out;
    quadrotor_regulator_status_t status = quadrotor_regulator_init(&state, &params);

    (void)printf("model %s, init: %s\n", quadrotor_regulator_model(), quadrotor_regulator_status_text(status));
    for (int k = 0; k < 10; k++)
    {
        /* fill `in` from the sensors here */
        status = quadrotor_regulator_step(&state, &params, &in, &out);
        if (status < QUADROTOR_REGULATOR_OK)
        {
            /* refused: the state is as it was before the call */
            (void)printf("step %d: %s\n", k, quadrotor_regulator_status_text(status));
        }
    }
    (void)printf("last status: %s\n", quadrotor_regulator_status_text(status));
    return (status < QUADROTOR_REGULATOR_OK) ? 1 : 0;
}
