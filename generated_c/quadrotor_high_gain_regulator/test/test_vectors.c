/* Test vectors of quadrotor_high_gain_regulator with their runner. Written by plantc 0.1.0 from model 0e531f3d.
 *
 * Each call starts from a stated memory; what it gives is compared with what the Python model gave, in units of the
 * natural size of each field. Build with quadrotor_high_gain_regulator.c; returns 0 if all agree. For hosts: it prints.
 */
#include "quadrotor_high_gain_regulator.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const quadrotor_high_gain_regulator_state_t memories[] = {
    {{{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {0U}},
    {{{9.5466f, 238.665f}}, {{14.3837f, 359.592f}}, {{11.0295f, 275.737f}}, {{0.0f, 0.0f}}, {0U}},
    {{{4.11992f, -16.3345f}}, {{7.52408f, 8.3055f}}, {{4.92518f, -14.7395f}}, {{15.3114f, 382.785f}}, {0U}},
    {{{3.79323f, -16.3345f}}, {{7.65603f, 7.45151f}}, {{4.60087f, -15.4775f}}, {{22.9671f, 382.785f}}, {0U}},
    {{{3.40288f, -17.926f}}, {{7.76324f, 6.406f}}, {{4.26866f, -16.044f}}, {{0.39046f, -373.023f}}, {0U}},
    {{{3.04752f, -17.847f}}, {{7.85288f, 5.44401f}}, {{3.92274f, -16.67f}}, {{7.98006f, 3.2285f}}, {0U}},
    {{{2.6702f, -18.3565f}}, {{7.9265f, 4.5625f}}, {{3.58934f, -16.67f}}, {{8.01403f, 2.46349f}}, {0U}},
    {{{2.29471f, -18.5655f}}, {{7.97347f, 3.4555f}}, {{3.19964f, -18.0775f}}, {{8.0192f, 1.36097f}}, {0U}},
    {{{1.90216f, -19.0965f}}, {{8.0113f, 2.67349f}}, {{2.83025f, -18.2735f}}, {{8.00938f, 0.434952f}}, {0U}},
    {{{1.50833f, -19.394f}}, {{8.02441f, 1.66448f}}, {{2.46478f, -18.2735f}}, {{7.9739f, -0.66957f}}, {0U}},
    {{{1.11637f, -19.496f}}, {{8.00834f, 0.430473f}}, {{2.06647f, -19.0945f}}, {{7.92095f, -1.65855f}}, {0U}},
    {{{0.71735f, -19.7235f}}, {{8.01695f, 0.430473f}}, {{1.68458f, -19.0945f}}, {{7.85092f, -2.58004f}}, {0U}},
    {{{0.317084f, -19.8684f}}, {{7.92006f, -2.20701f}}, {{1.28559f, -19.522f}}, {{7.75826f, -3.60655f}}, {0U}},
    {{{-0.08237f, -19.9206f}}, {{7.86604f, -2.45401f}}, {{0.88667f, -19.734f}}, {{7.64831f, -4.55205f}}, {0U}},
    {{{-0.486072f, -20.0528f}}, {{7.77508f, -3.50103f}}, {{0.489914f, -19.7859f}}, {{7.51645f, -5.57255f}}, {0U}},
    {{{-0.8861f, -20.0271f}}, {{7.70506f, -3.50103f}}, {{0.089336f, -19.9074f}}, {{7.36898f, -6.47306f}}, {0U}},
    {{{-1.28004f, -19.8619f}}, {{7.52964f, -6.13603f}}, {{-0.308162f, -19.8912f}}, {{7.20128f, -7.42905f}}, {0U}},
    {{{-1.67388f, -19.7769f}}, {{7.39734f, -6.37555f}}, {{-0.712796f, -20.0614f}}, {{7.0125f, -8.43406f}}, {0U}},
    {{{-2.0656f, -19.6814f}}, {{7.26983f, -6.37555f}}, {{-1.10985f, -19.957f}}, {{6.81804f, -9.07855f}}, {0U}},
    {{{-2.44987f, -19.4474f}}, {{7.03352f, -9.09557f}}, {{-1.50715f, -19.911f}}, {{6.59197f, -10.191f}}, {0U}},
    {{{-2.83882f, -19.4474f}}, {{6.85175f, -9.09209f}}, {{-1.89693f, -19.7f}}, {{6.35811f, -10.942f}}, {0U}},
    {{{-3.19773f, -18.6964f}}, {{6.63581f, -9.94458f}}, {{-2.28551f, -19.5645f}}, {{6.10533f, -11.7905f}}, {0U}},
    {{{-3.56278f, -18.4744f}}, {{6.40112f, -10.8396f}}, {{-2.66558f, -19.284f}}, {{5.83616f, -12.6245f}}, {0U}},
    {{{-3.91629f, -18.0749f}}, {{6.15267f, -11.6311f}}, {{-3.04314f, -19.081f}}, {{5.55463f, -13.3505f}}, {0U}},
    {{{-4.26181f, -17.6754f}}, {{5.92005f, -11.6311f}}, {{-3.40538f, -18.5965f}}, {{5.25454f, -14.1775f}}, {0U}},
    {{{-2.40991f, -60.2477f}}, {{9.03295f, 225.824f}}, {{7.89798f, 197.449f}}, {{0.0f, 0.0f}}, {0U}},
    {{{6.99272f, 11.0034f}}, {{2.43724f, 19.4594f}}, {{3.07633f, 19.2768f}}, {{7.38275f, 8.26047f}}, {0U}},
    {{{-6.96315f, -11.266f}}, {{-2.36505f, -19.2815f}}, {{-3.00213f, -18.8886f}}, {{-7.37189f, -9.14848f}}, {0U}},
    {{{3.55131f, 18.252f}}, {{-2.32329f, 18.191f}}, {{-1.65337f, 19.2698f}}, {{4.3581f, 17.4772f}}, {0U}},
    {{{-5.10598f, 14.5144f}}, {{-7.95102f, 1.1224f}}, {{-7.83933f, 2.76059f}}, {{-4.35926f, 16.0342f}}, {0U}},
    {{{4.25703f, 17.7066f}}, {{-1.49791f, 20.6344f}}, {{-0.864264f, 19.6085f}}, {{5.01277f, 16.5459f}}, {0U}},
    {{{1000000.0f, 1000000.0f}}, {{1000000.0f, 1000000.0f}}, {{1000000.0f, 1000000.0f}}, {{1000000.0f,
     1000000.0f}}, {0U}},
    {{{0.0f, 0.0f}}, {{1000000.0f, 1000000.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {0U}},
    {{{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{1000000.0f, 1000000.0f}}, {{0.0f, 0.0f}}, {0U}},
    {{{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{1000000.0f, 1000000.0f}}, {0U}}
};

/* The natural size of an error in each field of the memory. */
static const quadrotor_high_gain_regulator_state_t sizes = {{{1.0f, 1.0f}}, {{1.0f, 1.0f}}, {{1.0f, 1.0f}},
     {{1.0f, 1.0f}}, {0U}};

static const quadrotor_high_gain_regulator_params_t parameters[] = {
    {{{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f},
     {2.0f, 50.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, 212.718f}},
    {{{1200000.0f, 1200000.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}},
     {{0.0f, 0.0f}, {2.0f, 50.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     212.718f, 212.718f, 212.718f, 212.718f}},
    {{{0.0f, 0.0f}, {2.0f, 50.0f}}, {{1200000.0f, 1200000.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}},
     {{0.0f, 0.0f}, {2.0f, 50.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     212.718f, 212.718f, 212.718f, 212.718f}},
    {{{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{1200000.0f, 1200000.0f}, {2.0f, 50.0f}},
     {{0.0f, 0.0f}, {2.0f, 50.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     212.718f, 212.718f, 212.718f, 212.718f}},
    {{{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{1200000.0f,
     1200000.0f}, {2.0f, 50.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     212.718f, 212.718f, 212.718f, 212.718f}},
    {{{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f},
     {2.0f, 50.0f}}, {12000.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f}},
    {{{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f},
     {2.0f, 50.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     -10000.0f, 212.718f}},
    {{{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f}, {2.0f, 50.0f}}, {{0.0f, 0.0f},
     {2.0f, 50.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, -10000.0f}}
};

static const quadrotor_high_gain_regulator_step_in_t step_inputs[] = {
    {true, 4.7733f, true, 7.19183f, true, 5.51473f, false, 7.53222f, 1.50432f, -1.47733f, -1.42304f, 0.760669f,
     2.03536f, -0.597397f, 0.900856f, -0.683728f, -0.12289f, -0.935769f, -0.440316f, -0.347503f},
    {true, 4.44661f, true, 7.35797f, true, 5.21997f, true, 7.6557f, -1.0665f, -0.40258f, 1.85072f, 2.8423f,
     -0.0716766f, -0.270426f, 0.30017f, -0.35225f, -1.14252f, -0.349343f, -0.956053f, 2.27908f},
    {false, 4.11023f, true, 7.507f, true, 4.91042f, false, 7.76413f, 0.648555f, 0.800597f, 1.44726f, -0.502384f,
     1.87937f, -0.568522f, 0.230095f, 0.762011f, -0.222328f, -0.200758f, -1.25755f, -0.0944142f},
    {true, 3.7614f, true, 7.63512f, true, 4.58954f, true, 7.85093f, -0.822414f, 0.585777f, 0.826986f, 0.670919f,
     -1.43877f, 0.212979f, 0.740556f, -0.953701f, -0.266219f, 0.0326145f, -1.99312f, 1.01319f},
    {true, 3.40446f, true, 7.744f, true, 4.25614f, true, 7.91549f, -1.22388f, 0.0881837f, 1.09284f, 1.36318f,
     -3.08804f, 1.7867f, 0.792807f, -0.623531f, 0.520576f, -1.14434f, 2.42951f, 0.384579f},
    {true, 3.03733f, true, 7.83525f, false, 3.91284f, true, 7.96476f, 0.0960498f, 0.563497f, -0.292707f,
     -3.55686f, 0.52173f, 1.18995f, 0.248799f, -0.296641f, 0.495211f, -0.174703f, 1.4277f, 0.113379f},
    {true, 2.66602f, true, 7.90436f, true, 3.56119f, true, 7.99198f, 1.22101f, -0.90467f, 1.24283f, -0.0790645f,
     -0.991894f, 0.240435f, 1.16034f, 0.369493f, 1.90466f, 1.11106f, 1.16223f, -0.334212f},
    {true, 2.28409f, true, 7.95783f, true, 3.19572f, true, 8.00068f, -0.217569f, -2.34721f, -2.88757f,
     -0.0147167f, -0.495753f, 1.52112f, 1.40754f, 0.129102f, 1.61695f, 0.502741f, 1.23231f, -1.23327f},
    {true, 1.89621f, true, 7.99112f, false, 2.82489f, true, 7.98729f, -1.43153f, 1.02686f, 0.162807f, 1.48117f,
     -0.122356f, -2.62974f, -0.861316f, 0.674712f, 0.618539f, -0.443172f, 0.628217f, -1.97148f},
    {true, 1.50629f, true, 7.99973f, true, 2.44836f, true, 7.95412f, 0.714274f, -0.344531f, 0.382722f, -2.25895f,
     1.63103f, 1.16892f, 0.758806f, 0.884909f, -0.877282f, -0.867787f, -1.30683f, 2.43431f},
    {true, 1.11182f, false, 7.99265f, false, 2.0635f, true, 7.90252f, 0.553087f, -0.469553f, -0.0679805f,
     -0.120174f, -0.699168f, 0.865698f, -0.955425f, 0.58591f, 2.06578f, -1.47116f, -1.01675f, -0.937402f},
    {true, 0.714452f, true, 7.9642f, true, 1.67603f, true, 7.83039f, 0.397815f, -0.562502f, 1.2528f, -1.45861f,
     3.28268f, -0.00151281f, 0.621083f, 0.956122f, -0.705841f, 1.19269f, 0.416638f, 1.1041f},
    {true, 0.316041f, true, 7.91512f, true, 1.28135f, true, 7.73935f, 1.0092f, -0.29451f, -2.14719f, -1.93404f,
     -2.67464f, -2.28834f, 0.461164f, -1.17598f, 1.01013f, 0.920018f, -0.606696f, 2.08392f},
    {true, -0.0850148f, true, 7.8451f, true, 0.885632f, true, 7.6279f, -1.92146f, -0.116179f, 0.616844f,
     0.314784f, 2.34979f, -2.21815f, 2.13783f, -0.785534f, -1.75593f, 0.71479f, 1.43735f, 0.359634f},
    {true, -0.485558f, false, 7.75721f, true, 0.487484f, true, 7.49844f, -1.46192f, 3.87857f, -1.78191f,
     0.553991f, -0.654654f, 2.02743f, -0.422857f, 0.0864644f, -2.14247f, -0.830169f, -1.42155f, 2.02479f},
    {true, -0.882797f, true, 7.65236f, true, 0.0896609f, true, 7.34986f, 1.27677f, 1.16925f, -0.168885f,
     -1.74408f, -0.211601f, 1.18422f, 1.20846f, 1.1157f, 0.840862f, -0.102887f, 0.772096f, -0.799672f},
    {true, -1.27834f, true, 7.52485f, true, -0.311567f, true, 7.18118f, 0.343113f, -0.335853f, 0.247541f,
     0.0992469f, -1.2073f, 2.17982f, -0.625342f, -0.593843f, -0.343901f, -1.00017f, 0.51276f, 1.72665f},
    {true, -1.67197f, false, 7.37842f, true, -0.710707f, true, 6.99961f, 1.22854f, -0.813692f, 0.316416f,
     0.7516f, -1.18625f, 0.195386f, 1.46089f, 0.592473f, 1.19783f, 1.70459f, -0.912016f, -2.32077f},
    {true, -2.06092f, true, 7.21543f, true, -1.10893f, true, 6.79579f, 0.269897f, -2.04779f, -1.6715f,
     0.0719681f, -2.32055f, 0.613195f, 1.69381f, 0.19687f, 0.169869f, -1.16401f, -0.106181f, -1.04966f},
    {false, -2.44539f, true, 7.03359f, true, -1.50293f, true, 6.57695f, 1.74929f, 0.95423f, 0.714865f, 1.09576f,
     1.01721f, -0.996419f, 0.684001f, -0.35341f, -1.78791f, 0.361847f, 0.212091f, 0.677722f},
    {true, -2.8238f, true, 6.8347f, true, -1.89422f, true, 6.34114f, -1.04764f, -1.14127f, 1.86449f, -1.61627f,
     1.24312f, 1.58111f, -1.63745f, 3.0f, 0.648644f, 0.107343f, -1.62123f, 1.55193f},
    {true, -3.19329f, true, 6.61791f, true, -2.2799f, true, 6.08865f, 1.5339f, -0.176019f, 1.56303f, 0.32593f,
     0.921668f, -3.14575f, -0.595668f, -0.309121f, 0.510938f, 1.71066f, -1.07849f, 1.38651f},
    {true, -3.55479f, true, 6.38529f, true, -2.66152f, true, 5.82164f, -0.676177f, -1.18122f, -1.59393f,
     -0.984195f, -0.122609f, 0.417194f, 0.816044f, -0.612407f, 0.393109f, -1.82392f, 1.5043f, 0.968397f},
    {true, -3.9083f, false, 6.13557f, true, -3.03345f, true, 5.53809f, 0.945773f, 0.842498f, -1.27677f, 1.34036f,
     -1.63253f, 1.24333f, -1.89881f, -1.11711f, -0.508972f, -0.166486f, 0.507823f, 0.496747f},
    {true, (float)NAN, true, 4.17936f, true, 3.59464f, true, -2.49157f, -2.60174f, 2.33768f, -1.02046f,
     -1.61871f, -1.28098f, 1.20582f, 0.0665172f, 0.302472f, -0.634322f, -0.362741f, -2.28636f, -0.572293f},
    {true, -1.5998f, true, (float)INFINITY, true, 3.59464f, true, -2.49157f, -2.60174f, 2.33768f, -1.02046f,
     -1.61871f, -1.28098f, 1.20582f, 0.0665172f, 0.302472f, -0.634322f, -0.362741f, -2.28636f, -0.572293f},
    {true, 6.97764f, true, 2.43224f, true, (float)NAN, true, 7.38284f, -0.344424f, -0.315575f, -1.08279f,
     -0.0853425f, 0.249509f, 1.50243f, -0.777228f, -0.300004f, -1.00656f, -2.14331f, 2.61037f, 0.268952f},
    {false, -6.94341f, true, -2.36543f, true, -2.99385f, true, (float)NAN, -2.65068f, -1.64562f, -0.796426f,
     1.26719f, 1.99161f, 1.14075f, -1.33221f, -1.96862f, -0.660056f, 0.175819f, 0.15124f, 0.466704f},
    {true, 3.54876f, false, -2.29838f, true, -1.6486f, true, 4.35094f, 10000.0f, -1.20277f, 1.67386f, 0.295725f,
     -0.283661f, -2.25782f, 0.46629f, 1.71483f, -0.832186f, 0.172339f, -1.37355f, 0.690177f},
    {true, -5.09313f, true, -7.93237f, true, -7.82176f, false, -4.34898f, (float)NAN, 1.79514f, -1.29122f,
     0.516765f, -2.46484f, 3.42884f, 1.61805f, -0.824409f, 0.42258f, 0.547481f, -0.308408f, -1.08987f},
    {true, 4.24891f, false, -1.52287f, true, -0.858243f, true, 4.99805f, -0.926892f, 1.78933f, 0.338875f,
     3.34195f, 0.586737f, 0.0906803f, 0.859104f, -0.809627f, 0.873312f, 1.19974f, 1.01545f, 1000.0f},
    {true, 10.0f, true, 10.0f, true, 10.0f, true, 10.0f, 10000.0f, 10000.0f, 10000.0f, 10000.0f, 10000.0f,
     10000.0f, 30.0f, 1000.0f, 30.0f, 1000.0f, 30.0f, 1000.0f},
    {true, -1.20495f, true, 4.51647f, true, 3.94899f, true, -2.10871f, 1.3083f, -0.408491f, 3.76383f, -1.65952f,
     0.358826f, -1.04128f, 1.53278f, 1.46936f, 0.154947f, 0.378163f, -3.44078f, -1.32718f}
};

static const quadrotor_high_gain_regulator_step_out_t step_outputs[] = {
    {{{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {224.728f, 238.856f, 205.646f, 168.913f}},
    {{{9.5466f, 238.665f}}, {{14.3837f, 359.592f}}, {{11.0295f, 275.737f}}, {{0.0f, 0.0f}}, {4169.79f, 7446.88f,
     2692.65f, -512.056f}},
    {{{4.11992f, -16.3345f}}, {{7.52408f, 8.3055f}}, {{4.92518f, -14.7395f}}, {{15.3114f, 382.785f}}, {4160.57f,
     -3845.12f, 3796.84f, -3854.57f}},
    {{{3.79323f, -16.3345f}}, {{7.65603f, 7.45151f}}, {{4.60087f, -15.4775f}}, {{22.9671f, 382.785f}}, {4175.99f,
     -3878.56f, 3836.65f, -3887.18f}},
    {{{3.40288f, -17.926f}}, {{7.76324f, 6.406f}}, {{4.26866f, -16.044f}}, {{0.39046f, -373.023f}}, {-3520.9f,
     3765.43f, -3887.51f, 3817.25f}},
    {{{3.04752f, -17.847f}}, {{7.85288f, 5.44401f}}, {{3.92274f, -16.67f}}, {{7.98006f, 3.2285f}}, {303.61f,
     -62.4179f, -129.261f, -17.2824f}},
    {{{2.6702f, -18.3565f}}, {{7.9265f, 4.5625f}}, {{3.58934f, -16.67f}}, {{8.01403f, 2.46349f}}, {362.859f,
     -96.1921f, -158.341f, 53.4595f}},
    {{{2.29471f, -18.5655f}}, {{7.97347f, 3.4555f}}, {{3.19964f, -18.0775f}}, {{8.0192f, 1.36097f}}, {315.984f,
     -89.605f, -186.92f, -19.1545f}},
    {{{1.90216f, -19.0965f}}, {{8.0113f, 2.67349f}}, {{2.83025f, -18.2735f}}, {{8.00938f, 0.434952f}}, {258.213f,
     -124.354f, -43.2141f, 97.3202f}},
    {{{1.50833f, -19.394f}}, {{8.02441f, 1.66448f}}, {{2.46478f, -18.2735f}}, {{7.9739f, -0.66957f}}, {180.671f,
     -27.0997f, -165.782f, -16.9089f}},
    {{{1.11637f, -19.496f}}, {{8.00834f, 0.430473f}}, {{2.06647f, -19.0945f}}, {{7.92095f, -1.65855f}},
     {216.482f, -196.853f, -150.101f, 115.706f}},
    {{{0.71735f, -19.7235f}}, {{8.01695f, 0.430473f}}, {{1.68458f, -19.0945f}}, {{7.85092f, -2.58004f}},
     {158.116f, -60.9766f, -189.07f, 30.8015f}},
    {{{0.317084f, -19.8684f}}, {{7.92006f, -2.20701f}}, {{1.28559f, -19.522f}}, {{7.75826f, -3.60655f}},
     {227.134f, -68.7491f, -191.208f, 167.416f}},
    {{{-0.08237f, -19.9206f}}, {{7.86604f, -2.45401f}}, {{0.88667f, -19.734f}}, {{7.64831f, -4.55205f}}, {127.7f,
     15.2468f, -157.604f, 28.9217f}},
    {{{-0.486072f, -20.0528f}}, {{7.77508f, -3.50103f}}, {{0.489914f, -19.7859f}}, {{7.51645f, -5.57255f}},
     {21.0633f, -83.4064f, -151.1f, 81.1505f}},
    {{{-0.8861f, -20.0271f}}, {{7.70506f, -3.50103f}}, {{0.089336f, -19.9074f}}, {{7.36898f, -6.47306f}},
     {178.358f, -110.958f, -284.689f, 101.581f}},
    {{{-1.28004f, -19.8619f}}, {{7.52964f, -6.13603f}}, {{-0.308162f, -19.8912f}}, {{7.20128f, -7.42905f}},
     {-10.973f, -126.789f, -180.829f, 169.561f}},
    {{{-1.67388f, -19.7769f}}, {{7.39734f, -6.37555f}}, {{-0.712796f, -20.0614f}}, {{7.0125f, -8.43406f}},
     {167.16f, -146.905f, -248.242f, 154.187f}},
    {{{-2.0656f, -19.6814f}}, {{7.26983f, -6.37555f}}, {{-1.10985f, -19.957f}}, {{6.81804f, -9.07855f}},
     {101.012f, -48.2981f, -230.245f, 103.869f}},
    {{{-2.44987f, -19.4474f}}, {{7.03352f, -9.09557f}}, {{-1.50715f, -19.911f}}, {{6.59197f, -10.191f}},
     {-17.0876f, -63.318f, -173.154f, 182.329f}},
    {{{-2.83882f, -19.4474f}}, {{6.85175f, -9.09209f}}, {{-1.89693f, -19.7f}}, {{6.35811f, -10.942f}},
     {-44.3926f, -162.186f, -223.253f, 237.296f}},
    {{{-3.19773f, -18.6964f}}, {{6.63581f, -9.94458f}}, {{-2.28551f, -19.5645f}}, {{6.10533f, -11.7905f}},
     {11.342f, -124.457f, -189.075f, 332.531f}},
    {{{-3.56278f, -18.4744f}}, {{6.40112f, -10.8396f}}, {{-2.66558f, -19.284f}}, {{5.83616f, -12.6245f}},
     {-29.7236f, -46.5728f, -253.585f, 222.011f}},
    {{{-3.91629f, -18.0749f}}, {{6.15267f, -11.6311f}}, {{-3.04314f, -19.081f}}, {{5.55463f, -13.3505f}},
     {-129.609f, -155.401f, -154.899f, 325.713f}},
    {{{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {{0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f}}
};

enum entry
{
    ENTRY_INIT,
    ENTRY_STEP
};

struct vector
{
    enum entry entry;
    int start;
    int inputs;
    int parameters;
    int expected;
    int outputs;
    quadrotor_high_gain_regulator_status_t status;
};

static const struct vector vectors[] = {
    { ENTRY_INIT, 0, 0, 0, 0, 0, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 0, 0, 0, 1, 0, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 1, 1, 0, 2, 1, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 2, 2, 0, 3, 2, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 3, 3, 0, 4, 3, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 4, 4, 0, 5, 4, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 5, 5, 0, 6, 5, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 6, 6, 0, 7, 6, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 7, 7, 0, 8, 7, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 8, 8, 0, 9, 8, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 9, 9, 0, 10, 9, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 10, 10, 0, 11, 10, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 11, 11, 0, 12, 11, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 12, 12, 0, 13, 12, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 13, 13, 0, 14, 13, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 14, 14, 0, 15, 14, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 15, 15, 0, 16, 15, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 16, 16, 0, 17, 16, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 17, 17, 0, 18, 17, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 18, 18, 0, 19, 18, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 19, 19, 0, 20, 19, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 20, 20, 0, 21, 20, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 21, 21, 0, 22, 21, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 22, 22, 0, 23, 22, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 23, 23, 0, 24, 23, QUADROTOR_HIGH_GAIN_REGULATOR_OK },
    { ENTRY_STEP, 25, 24, 0, 25, 24, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT },
    { ENTRY_STEP, 25, 25, 0, 25, 24, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT },
    { ENTRY_STEP, 26, 26, 0, 26, 24, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT },
    { ENTRY_STEP, 27, 27, 0, 27, 24, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT },
    { ENTRY_STEP, 28, 28, 0, 28, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 29, 29, 0, 29, 24, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT },
    { ENTRY_STEP, 30, 30, 0, 30, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW },
    { ENTRY_INIT, 0, 0, 1, 0, 0, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 2, 0, 0, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 3, 0, 0, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 4, 0, 0, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 5, 0, 0, QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM },
    { ENTRY_STEP, 31, 31, 0, 31, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 32, 32, 0, 32, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 33, 32, 0, 33, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 34, 32, 0, 34, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 0, 32, 6, 0, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 0, 32, 7, 0, 24, QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW }
};

static int differs(float value, float expected, float size)
{
    const int both_nan = (value != value) && (expected != expected);

    return !both_nan && !(fabsf(value - expected) <= (0.002f * (fabsf(expected) + size)));
}

static int memory_differs(const quadrotor_high_gain_regulator_state_t *state,
     const quadrotor_high_gain_regulator_state_t *wanted)
{
    int count = 0;

    for (int i = 0; i < 2; i++)
    {
        count += differs(state->generator_x.observer_reading[i], wanted->generator_x.observer_reading[i],
     sizes.generator_x.observer_reading[i]);
    }
    for (int i = 0; i < 2; i++)
    {
        count += differs(state->generator_y.observer_reading[i], wanted->generator_y.observer_reading[i],
     sizes.generator_y.observer_reading[i]);
    }
    for (int i = 0; i < 2; i++)
    {
        count += differs(state->generator_z.observer_reading[i], wanted->generator_z.observer_reading[i],
     sizes.generator_z.observer_reading[i]);
    }
    for (int i = 0; i < 2; i++)
    {
        count += differs(state->generator_yaw.observer_reading[i], wanted->generator_yaw.observer_reading[i],
     sizes.generator_yaw.observer_reading[i]);
    }
    return count;
}

/* Every status has a sentence of its own, and so has a value that is none; the model has its hash. */
static int texts_are_wrong(void)
{
    static const quadrotor_high_gain_regulator_status_t known[] = {
        QUADROTOR_HIGH_GAIN_REGULATOR_OK,
        QUADROTOR_HIGH_GAIN_REGULATOR_GATED,
        QUADROTOR_HIGH_GAIN_REGULATOR_CLAMPED,
        QUADROTOR_HIGH_GAIN_REGULATOR_SKIPPED,
        QUADROTOR_HIGH_GAIN_REGULATOR_RECOVERED,
        QUADROTOR_HIGH_GAIN_REGULATOR_BAD_INPUT,
        QUADROTOR_HIGH_GAIN_REGULATOR_BAD_PARAM,
        QUADROTOR_HIGH_GAIN_REGULATOR_NOT_POSITIVE,
        QUADROTOR_HIGH_GAIN_REGULATOR_OVERFLOW
    };
    const char *const unknown = quadrotor_high_gain_regulator_status_text((quadrotor_high_gain_regulator_status_t)127);
    int wrong = (strcmp(quadrotor_high_gain_regulator_model(), "0e531f3d") != 0);

    for (size_t i = 0; i < (sizeof(known) / sizeof(known[0])); i++)
    {
        wrong += (strcmp(quadrotor_high_gain_regulator_status_text(known[i]), unknown) == 0);
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
        quadrotor_high_gain_regulator_state_t state = memories[v->start];
        quadrotor_high_gain_regulator_status_t status = QUADROTOR_HIGH_GAIN_REGULATOR_OK;
        int count = 0;

        switch (v->entry)
        {
            case ENTRY_INIT:
            {
                status = quadrotor_high_gain_regulator_init(&state, &parameters[v->parameters]);
                break;
            }
            case ENTRY_STEP:
            {
                quadrotor_high_gain_regulator_step_out_t answer = step_outputs[v->outputs];
                const quadrotor_high_gain_regulator_step_out_t *const expected =
                    &step_outputs[v->outputs];

                status = quadrotor_high_gain_regulator_step(&state, &parameters[v->parameters],
     &step_inputs[v->inputs], &answer);
                for (int i = 0; i < 2; i++)
                {
                    count += differs(answer.generator_x.w_reading[i], expected->generator_x.w_reading[i], 1.0f);
                }
                for (int i = 0; i < 2; i++)
                {
                    count += differs(answer.generator_y.w_reading[i], expected->generator_y.w_reading[i], 1.0f);
                }
                for (int i = 0; i < 2; i++)
                {
                    count += differs(answer.generator_z.w_reading[i], expected->generator_z.w_reading[i], 1.0f);
                }
                for (int i = 0; i < 2; i++)
                {
                    count += differs(answer.generator_yaw.w_reading[i], expected->generator_yaw.w_reading[i], 1.0f);
                }
                count += differs(answer.feedback.rotor_1, expected->feedback.rotor_1, 1.0f);
                count += differs(answer.feedback.rotor_2, expected->feedback.rotor_2, 1.0f);
                count += differs(answer.feedback.rotor_3, expected->feedback.rotor_3, 1.0f);
                count += differs(answer.feedback.rotor_4, expected->feedback.rotor_4, 1.0f);
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
