/* Test vectors of pendulum_ekf with their runner. Written by plantc 0.1.0 from model 65098682.
 *
 * Each call starts from a stated memory; what it gives is compared with what the Python model gave, in units of the
 * natural size of each field. Build with pendulum_ekf.c; returns 0 if all agree. For hosts: it prints.
 */
#include "pendulum_ekf.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const pendulum_ekf_state_t memories[] = {
    {0.0f, 0.0f, {0.0f, 0.0f, 0.0f}, 0U},
    {0.0f, 0.0f, {1.0f, 0.0f, 1.0f}, 0U},
    {1.59542f, -1.57764f, {0.00009999f, -0.0000899301f, 1.11195f}, 0U},
    {1.57362f, -1.89509f, {0.000310111f, 0.0153117f, 1.11748f}, 0U},
    {1.51524f, -2.56302f, {0.0000963801f, 0.00194344f, 0.0877855f}, 0U},
    {1.46876f, -3.12899f, {0.000061549f, 0.00118711f, 0.056155f}, 0U},
    {1.46876f, -3.12899f, {0.0000989277f, 0.00190804f, 0.0902579f}, 0U},
    {1.42771f, -3.5018f, {0.0000606005f, 0.00116286f, 0.0603731f}, 0U},
    {1.39238f, -3.68287f, {0.0000485808f, 0.000957964f, 0.0469404f}, 0U},
    {1.34781f, -3.87986f, {0.0000456699f, 0.00088932f, 0.0377813f}, 0U},
    {1.12916f, -5.16476f, {0.000289767f, 0.00363032f, 0.0598916f}, 0U},
    {0.895122f, -6.20639f, {0.0000876283f, 0.000783386f, 0.0245147f}, 0U},
    {0.391426f, -7.87407f, {0.0000805349f, 0.000722526f, 0.0270559f}, 0U},
    {0.00453716f, -8.35839f, {0.0000702225f, 0.00073211f, 0.0277191f}, 0U},
    {-0.106712f, -8.40416f, {0.000094936f, 0.0011156f, 0.0326655f}, 0U},
    {-0.250416f, -8.42628f, {0.000143305f, 0.00169459f, 0.0387714f}, 0U},
    {-0.246223f, -8.3767f, {0.0000588993f, 0.000696488f, 0.0269688f}, 0U},
    {-0.384655f, -8.40327f, {0.000046968f, 0.000613525f, 0.0258409f}, 0U},
    {-0.526759f, -8.25307f, {0.000043433f, 0.000624828f, 0.0255049f}, 0U},
    {-1.30918f, -7.35697f, {0.000084138f, 0.000766906f, 0.0254451f}, 0U},
    {-1.39728f, -7.17734f, {0.0000513788f, 0.000527535f, 0.0242911f}, 0U},
    {-2.00091f, -5.73458f, {0.000391245f, 0.00395784f, 0.0576356f}, 0U},
    {-2.49122f, -4.39142f, {0.00157273f, 0.0108582f, 0.0975644f}, 0U},
    {-2.66739f, -4.56068f, {0.0000955881f, 0.000621143f, 0.0284897f}, 0U},
    {-3.07197f, -3.8349f, {0.000523065f, 0.00495566f, 0.0661263f}, 0U},
    {0.355592f, 8.43401f, {0.000051339f, 0.000699364f, 0.0322087f}, 0U},
    {0.633143f, 8.16954f, {0.000137002f, 0.00193089f, 0.0445443f}, 0U},
    {-0.0529356f, 0.328434f, {0.00368227f, -0.0271704f, 0.417871f}, 2U},
    {-0.900346f, 6.66507f, {0.000110586f, -0.000818013f, 39.1179f}, 0U},
    {1.28598f, -1.507f, {0.00118648f, 0.000582305f, 0.00105294f}, 2U},
    {1.27023f, -1.67276f, {0.00119939f, 0.000609438f, 0.0180563f}, 3U},
    {3.06941f, -0.417727f, {1.4334e8f, 2.1303e9f, 4.65185e10f}, 0U},
    {3.06329f, -0.488173f, {2.15782e8f, 4.14192e8f, 1.0e9f}, 0U},
    {3.037f, 100.0f, {0.0000319593f, 0.000404326f, 0.0205532f}, 0U},
    {1.55559f, -3.17904f, {0.0000514943f, 0.000741096f, 0.0242462f}, 0U},
    {2.182f, -100.0f, {0.0000490402f, 0.000690653f, 0.024468f}, 0U},
    {2.48267f, 2.61783f, {0.0000322289f, 0.000583222f, 0.027617f}, 0U},
    {3.07796f, -0.306934f, {0.0000442756f, 0.000721586f, 0.0254381f}, 0U},
    {2.41621f, 2.84342f, {3.81061e7f, 5.56992e8f, 2.23799e10f}, 0U},
    {2.41621f, 2.84342f, {6.05247e7f, 1.48385e8f, 1.0e9f}, 0U},
    {1.48999f, 0.491099f, {0.0527346f, -0.0380465f, 0.683672f}, 1U},
    {1.48999f, 0.491099f, {0.0527346f, -0.0380465f, 0.683672f}, 2U},
    {-0.293486f, -6.48391f, {0.000106992f, 0.00141002f, 0.0360401f}, 0U},
    {-0.293486f, 100.0f, {0.000106992f, 0.00141002f, 0.0360401f}, 0U},
    {2.41621f, 2.84342f, {0.0000605246f, 0.000884681f, 0.0355463f}, 0U},
    {2.44577f, 2.69183f, {0.0000829107f, 0.00128648f, 0.0399762f}, 0U},
    {1.74099f, -1.64598f, {0.0f, 0.0f, 0.0f}, 0U},
    {1.70296f, -1.55675f, {1.0e-20f, 0.0f, 1.0e-20f}, 0U},
    {(float)NAN, -1.64598f, {0.0000465158f, 0.000785892f, 0.0307252f}, 0U},
    {1.74099f, -1.64598f, {0.0000465158f, 1.0e9f, 0.0307252f}, 0U},
    {1.74099f, -1.64598f, {1.0e9f, 0.0f, 1.0e9f}, 0U},
    {1.70296f, -2.00353f, {1.0e9f, 9.95669e7f, 1.0e9f}, 0U},
    {1.77964f, -2.48498f, {0.0f, 0.0f, 0.0f}, 0U},
    {1.77964f, -2.48498f, {1.0e-20f, 0.0f, 1.0e-20f}, 0U},
    {(float)NAN, -2.48498f, {0.000274354f, 0.0149641f, 1.28474f}, 0U},
    {0.0f, 0.0f, {1.0f, 0.0f, 1.0f}, 3U},
    {0.0f, 0.296948f, {1.00614f, -1.45007f, 3.36971f}, 3U}
};

/* The natural size of an error in each field of the memory. */
static const pendulum_ekf_state_t sizes = {1.0f, 1.0f, {1.0f, 1.0f, 1.0f}, 0U};

static const pendulum_ekf_params_t parameters[] = {
    {0.2f, 0.5f, 9.81f, 0.001f, 0.0001f, 0.0f, 0U, 100.0f, 0.0f, 0.0f, 1.0f, 1.0f},
    {0.185729f, 0.541767f, 12.3998f, 0.000995685f, 0.000110617f, 9.7527f, 1U, 136.919f, 0.0f, 0.0f, 1.21319f,
     0.779478f},
    {0.1804f, 0.38935f, 8.12389f, 0.00122166f, 0.000104137f, 0.0889063f, 0U, 94.385f, 0.0f, 0.0f, 1.20907f, 1.29812f},
    {0.2f, 0.5f, -1.0e-45f, 0.001f, 0.0001f, 0.0f, 0U, 100.0f, 0.0f, 0.0f, 1.0f, 1.0f},
    {0.2f, 0.5f, 9.81f, 0.001f, -1000.0f, 0.0f, 0U, 100.0f, 0.0f, 0.0f, 1.0f, 1.0f},
    {0.175205f, 0.69755f, 10.3891f, 0.000943389f, 0.000121175f, 0.55074f, 1U, 120.944f, 0.0f, 0.0f, 0.825857f,
     1.03604f},
    {0.2f, 0.5f, 0.0f, 0.0f, 0.0001f, 0.0f, 0U, 100.0f, 0.0f, 0.0f, 1.0f, 1.0f},
    {0.2f, 0.5f, 9.81f, 0.001f, 0.0001f, 0.0f, 2U, 100.0f, 0.0f, 0.0f, 1.0f, 1.0f}
};

static const pendulum_ekf_predict_in_t predict_inputs[] = {
    {-0.108527f, 0.0841023f},
    {-0.0388779f, 0.0887095f},
    {-0.169565f, 0.0146571f},
    {(float)NAN, 0.0158488f},
    {0.15398f, 0.0158488f},
    {0.193086f, 0.0231053f}
};

static const pendulum_ekf_update_encoder_in_t update_encoder_inputs[] = {
    {-0.243297f},
    {3.04468f},
    {2.49203f},
    {(float)NAN},
    {1.7841f}
};

static const pendulum_ekf_update_encoder_out_t update_encoder_outputs[] = {
    {0.00711901f, 0.000243305f, 0.2083f},
    {0.0f, 0.0f, 0.0f},
    {1.00204f, 0.0528558f, 18.9967f},
    {0.0044601f, 0.0001f, 0.198925f}
};

static const pendulum_ekf_step_in_t step_inputs[] = {
    {-0.147324f, 0.0484417f, true, 1.59558f},
    {-0.168141f, 0.0138161f, false, 1.58642f},
    {-0.183741f, 0.0341323f, true, 1.51548f},
    {-0.189218f, 0.0126831f, true, 1.46003f},
    {-0.191377f, 0.0113074f, true, 1.42402f},
    {-0.183822f, 0.011219f, true, 1.39657f},
    {-0.175855f, 0.0137238f, true, 1.35491f},
    {-0.183264f, 0.0563563f, false, 1.10812f},
    {-0.166491f, 0.04185f, true, 0.892596f},
    {-0.16478f, 0.0769028f, true, 0.385043f},
    {-0.163476f, 0.0497529f, true, 0.00660182f},
    {-0.167503f, 0.0133099f, false, -0.125508f},
    {-0.16917f, 0.0170991f, false, -0.247044f},
    {-0.131751f, 0.0159696f, true, -0.389916f},
    {-0.0963372f, 0.0173719f, true, -0.521709f},
    {-0.133978f, 0.0974128f, true, -1.30512f},
    {-0.0713985f, 0.0116502f, true, -1.39954f},
    {-0.106187f, 0.0855012f, false, -2.55831f},
    {-0.0337277f, 0.0245475f, true, -2.67055f},
    {-0.0602899f, 0.0329085f, true, (float)INFINITY},
    {0.0274647f, 0.0164777f, true, -0.900584f},
    {0.113846f, 0.0104502f, true, 3.04643f},
    {(float)NAN, 0.0368639f, true, 1.41553f},
    {-0.146847f, 0.0474507f, true, 2.37176f},
    {-0.0782363f, 0.0103961f, true, 2.45436f},
    {0.190492f, 0.0779423f, true, 1200.0f}
};

static const pendulum_ekf_step_out_t step_outputs[] = {
    {(pendulum_ekf_status_t)0, {1.59558f, 1.00246f, 2.53962f}},
    {(pendulum_ekf_status_t)0, {0.0f, 0.0f, 0.0f}},
    {(pendulum_ekf_status_t)0, {0.00654386f, 0.00276254f, 0.015501f}},
    {(pendulum_ekf_status_t)0, {-0.022703f, 0.000260071f, 1.98186f}},
    {(pendulum_ekf_status_t)0, {-0.00935922f, 0.000253811f, 0.34512f}},
    {(pendulum_ekf_status_t)0, {0.00814661f, 0.00019448f, 0.341255f}},
    {(pendulum_ekf_status_t)0, {0.013073f, 0.00018406f, 0.928517f}},
    {(pendulum_ekf_status_t)0, {-0.0204188f, 0.000808293f, 0.515813f}},
    {(pendulum_ekf_status_t)0, {-0.0327902f, 0.000513739f, 2.09289f}},
    {(pendulum_ekf_status_t)0, {0.00693364f, 0.000335824f, 0.143156f}},
    {(pendulum_ekf_status_t)0, {-0.00992044f, 0.000188565f, 0.521915f}},
    {(pendulum_ekf_status_t)0, {0.00892674f, 0.000176782f, 0.450764f}},
    {(pendulum_ekf_status_t)0, {0.0255937f, 0.000630438f, 1.03902f}},
    {(pendulum_ekf_status_t)0, {-0.00464976f, 0.000205672f, 0.10512f}},
    {(pendulum_ekf_status_t)0, {-0.0715317f, 0.00226658f, 2.2575f}},
    {(pendulum_ekf_status_t)-1, {0.0f, 0.0f, 0.0f}},
    {(pendulum_ekf_status_t)0, {-0.85306f, 0.397288f, 1.8317f}},
    {(pendulum_ekf_status_t)1, {1.7762f, 0.00130352f, 2420.27f}},
    {(pendulum_ekf_status_t)-3, {0.0f, 0.0f, 0.0f}}
};

static const pendulum_ekf_inflate_in_t inflate_inputs[] = {
    {1.6073f},
    {(float)NAN},
    {1.58832f}
};

enum entry
{
    ENTRY_INIT,
    ENTRY_PREDICT,
    ENTRY_UPDATE_ENCODER,
    ENTRY_STEP,
    ENTRY_INFLATE
};

struct vector
{
    enum entry entry;
    int start;
    int inputs;
    int parameters;
    int expected;
    int outputs;
    pendulum_ekf_status_t status;
};

static const struct vector vectors[] = {
    { ENTRY_INIT, 0, 0, 0, 1, 0, PENDULUM_EKF_OK },
    { ENTRY_STEP, 1, 0, 0, 2, 0, PENDULUM_EKF_OK },
    { ENTRY_STEP, 2, 1, 0, 3, 1, PENDULUM_EKF_OK },
    { ENTRY_STEP, 3, 2, 0, 4, 2, PENDULUM_EKF_OK },
    { ENTRY_STEP, 4, 3, 0, 5, 3, PENDULUM_EKF_OK },
    { ENTRY_INFLATE, 5, 0, 0, 6, 0, PENDULUM_EKF_OK },
    { ENTRY_STEP, 6, 4, 0, 7, 4, PENDULUM_EKF_OK },
    { ENTRY_STEP, 7, 5, 0, 8, 5, PENDULUM_EKF_OK },
    { ENTRY_STEP, 8, 6, 0, 9, 6, PENDULUM_EKF_OK },
    { ENTRY_STEP, 9, 7, 0, 10, 1, PENDULUM_EKF_OK },
    { ENTRY_STEP, 10, 8, 0, 11, 7, PENDULUM_EKF_OK },
    { ENTRY_STEP, 11, 9, 0, 12, 8, PENDULUM_EKF_OK },
    { ENTRY_STEP, 12, 10, 0, 13, 9, PENDULUM_EKF_OK },
    { ENTRY_STEP, 13, 11, 0, 14, 1, PENDULUM_EKF_OK },
    { ENTRY_STEP, 14, 12, 0, 15, 1, PENDULUM_EKF_OK },
    { ENTRY_UPDATE_ENCODER, 15, 0, 0, 16, 0, PENDULUM_EKF_OK },
    { ENTRY_STEP, 16, 13, 0, 17, 10, PENDULUM_EKF_OK },
    { ENTRY_STEP, 17, 14, 0, 18, 11, PENDULUM_EKF_OK },
    { ENTRY_STEP, 18, 15, 0, 19, 12, PENDULUM_EKF_OK },
    { ENTRY_STEP, 19, 16, 0, 20, 13, PENDULUM_EKF_OK },
    { ENTRY_PREDICT, 20, 0, 0, 21, 0, PENDULUM_EKF_OK },
    { ENTRY_STEP, 21, 17, 0, 22, 1, PENDULUM_EKF_OK },
    { ENTRY_STEP, 22, 18, 0, 23, 14, PENDULUM_EKF_OK },
    { ENTRY_PREDICT, 23, 1, 0, 24, 0, PENDULUM_EKF_OK },
    { ENTRY_STEP, 25, 19, 0, 26, 15, PENDULUM_EKF_SKIPPED },
    { ENTRY_STEP, 27, 20, 1, 28, 16, PENDULUM_EKF_RECOVERED },
    { ENTRY_STEP, 29, 21, 2, 30, 17, PENDULUM_EKF_GATED },
    { ENTRY_PREDICT, 31, 2, 0, 32, 0, PENDULUM_EKF_CLAMPED },
    { ENTRY_UPDATE_ENCODER, 33, 1, 0, 33, 1, PENDULUM_EKF_OVERFLOW },
    { ENTRY_STEP, 34, 22, 0, 34, 1, PENDULUM_EKF_BAD_INPUT },
    { ENTRY_STEP, 35, 23, 0, 35, 1, PENDULUM_EKF_OVERFLOW },
    { ENTRY_INIT, 0, 0, 3, 0, 0, PENDULUM_EKF_BAD_PARAM },
    { ENTRY_UPDATE_ENCODER, 36, 2, 4, 36, 1, PENDULUM_EKF_NOT_POSITIVE },
    { ENTRY_INFLATE, 37, 1, 0, 37, 0, PENDULUM_EKF_BAD_INPUT },
    { ENTRY_INFLATE, 38, 2, 0, 39, 0, PENDULUM_EKF_CLAMPED },
    { ENTRY_UPDATE_ENCODER, 40, 2, 5, 41, 2, PENDULUM_EKF_GATED },
    { ENTRY_PREDICT, 42, 3, 0, 42, 0, PENDULUM_EKF_BAD_INPUT },
    { ENTRY_PREDICT, 43, 4, 0, 43, 0, PENDULUM_EKF_OVERFLOW },
    { ENTRY_UPDATE_ENCODER, 36, 3, 0, 36, 1, PENDULUM_EKF_BAD_INPUT },
    { ENTRY_STEP, 44, 24, 4, 45, 18, PENDULUM_EKF_SKIPPED },
    { ENTRY_PREDICT, 46, 5, 6, 47, 0, PENDULUM_EKF_CLAMPED },
    { ENTRY_PREDICT, 48, 5, 0, 48, 0, PENDULUM_EKF_NOT_POSITIVE },
    { ENTRY_PREDICT, 49, 5, 0, 49, 0, PENDULUM_EKF_OVERFLOW },
    { ENTRY_PREDICT, 50, 5, 0, 51, 0, PENDULUM_EKF_CLAMPED },
    { ENTRY_UPDATE_ENCODER, 52, 4, 6, 53, 3, PENDULUM_EKF_CLAMPED },
    { ENTRY_UPDATE_ENCODER, 54, 4, 0, 54, 1, PENDULUM_EKF_OVERFLOW },
    { ENTRY_STEP, 55, 25, 7, 56, 15, PENDULUM_EKF_SKIPPED }
};

static int differs(float value, float expected, float size)
{
    const int both_nan = (value != value) && (expected != expected);

    return !both_nan && !(fabsf(value - expected) <= (0.002f * (fabsf(expected) + size)));
}

static int memory_differs(const pendulum_ekf_state_t *state, const pendulum_ekf_state_t *wanted)
{
    int count = 0;

    count += differs(state->theta, wanted->theta, sizes.theta) && differs(fabsf(state->theta - wanted->theta),
     6.2831855f, sizes.theta);
    count += differs(state->omega, wanted->omega, sizes.omega);
    for (int i = 0; i < 3; i++)
    {
        count += differs(state->covariance[i], wanted->covariance[i], sizes.covariance[i]);
    }
    count += (state->rejected_encoder != wanted->rejected_encoder);
    return count;
}

/* Every status has a sentence of its own, and so has a value that is none; the model has its hash. */
static int texts_are_wrong(void)
{
    static const pendulum_ekf_status_t known[] = {
        PENDULUM_EKF_OK,
        PENDULUM_EKF_GATED,
        PENDULUM_EKF_CLAMPED,
        PENDULUM_EKF_SKIPPED,
        PENDULUM_EKF_RECOVERED,
        PENDULUM_EKF_BAD_INPUT,
        PENDULUM_EKF_BAD_PARAM,
        PENDULUM_EKF_NOT_POSITIVE,
        PENDULUM_EKF_OVERFLOW
    };
    const char *const unknown = pendulum_ekf_status_text((pendulum_ekf_status_t)127);
    int wrong = (strcmp(pendulum_ekf_model(), "65098682") != 0);

    for (size_t i = 0; i < (sizeof(known) / sizeof(known[0])); i++)
    {
        wrong += (strcmp(pendulum_ekf_status_text(known[i]), unknown) == 0);
    }
    return wrong;
}

int main(void)
{
    const int total = (int)(sizeof(vectors) / sizeof(vectors[0]));
    int failed = 0;

    for (int k = 0; k < total; k++)
    {
        const struct vector *const v = &vectors[k];
        pendulum_ekf_state_t state = memories[v->start];
        pendulum_ekf_status_t status = PENDULUM_EKF_OK;
        int count = 0;

        switch (v->entry)
        {
            case ENTRY_INIT:
            {
                status = pendulum_ekf_init(&state, &parameters[v->parameters]);
                break;
            }
            case ENTRY_PREDICT:
            {
                status = pendulum_ekf_predict(&state, &parameters[v->parameters], &predict_inputs[v->inputs]);
                break;
            }
            case ENTRY_UPDATE_ENCODER:
            {
                pendulum_ekf_update_encoder_out_t answer = update_encoder_outputs[v->outputs];
                const pendulum_ekf_update_encoder_out_t *const expected =
                    &update_encoder_outputs[v->outputs];

                status = pendulum_ekf_update_encoder(&state, &parameters[v->parameters],
     &update_encoder_inputs[v->inputs], &answer);
                count += differs(answer.innovation, expected->innovation,
     1.0f) && differs(fabsf(answer.innovation - expected->innovation), 6.2831855f, 1.0f);
                count += differs(answer.variance, expected->variance, 1.0f);
                count += differs(answer.nis, expected->nis, 1.0f);
                break;
            }
            case ENTRY_STEP:
            {
                pendulum_ekf_step_out_t answer = step_outputs[v->outputs];
                const pendulum_ekf_step_out_t *const expected =
                    &step_outputs[v->outputs];

                status = pendulum_ekf_step(&state, &parameters[v->parameters], &step_inputs[v->inputs], &answer);
                count += (answer.status_encoder != expected->status_encoder);
                count += differs(answer.encoder.innovation, expected->encoder.innovation,
     1.0f) && differs(fabsf(answer.encoder.innovation - expected->encoder.innovation), 6.2831855f, 1.0f);
                count += differs(answer.encoder.variance, expected->encoder.variance, 1.0f);
                count += differs(answer.encoder.nis, expected->encoder.nis, 1.0f);
                break;
            }
            case ENTRY_INFLATE:
            {
                status = pendulum_ekf_inflate(&state, &parameters[v->parameters], &inflate_inputs[v->inputs]);
                break;
            }
            default:
                count = 1;
                break;
        }
        count += (status != v->status);
        count += memory_differs(&state, &memories[v->expected]);
        if (count > 0)
        {
            (void)printf("vector %d: %d value(s) differ; status %d, expected %d\n", k, count, (int)status,
     (int)v->status);
            failed++;
        }
    }
    if (texts_are_wrong() > 0)
    {
        (void)printf("the texts of the statuses, or the hash of the model, are not as they should be\n");
        failed++;
    }
    (void)printf("%d vectors, %d failed\n", total, failed);
    return (failed == 0) ? 0 : 1;
}
