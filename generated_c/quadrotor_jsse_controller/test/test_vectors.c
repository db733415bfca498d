/* Test vectors of quadrotor_jsse_controller with their runner. Written by plantc 0.1.0 from model 3848e263.
 *
 * Each call starts from a stated memory; what it gives is compared with what the Python model gave, in units of the
 * natural size of each field. Build with quadrotor_jsse_controller.c; returns 0 if all agree. For hosts: it prints.
 */
#include "quadrotor_jsse_controller.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const quadrotor_jsse_controller_state_t memories[] = {
    {0.0f, 0.0f, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, {0U}},
    {157.985f, 150.566f, 151.571f, 152.192f, {0.102717f, 0.0918178f, -0.0247641f, -0.0494115f, 30.0634f,
     -0.154312f, 0.0329478f, -0.0632766f, 0.00689761f, 0.0189939f, 0.128088f, -0.0645154f}, {0U}},
    {107.82f, 168.19f, 99.3243f, 163.133f, {0.12467f, 0.0602146f, -0.0527446f, -0.0743879f, 30.0672f, -0.264476f,
     0.1011f, -0.121662f, 0.00403843f, -0.10957f, 0.140177f, -0.0965074f}, {0U}},
    {137.343f, 204.484f, 131.482f, 199.285f, {0.100628f, 0.0664623f, -0.029094f, -0.0956143f, 30.0419f,
     -0.407579f, 0.106731f, -0.276553f, -0.0143198f, -0.101076f, 0.149882f, -0.188779f}, {0U}},
    {162.748f, 206.562f, 158.29f, 203.475f, {0.10229f, 0.0667395f, -0.0314844f, -0.112654f, 30.0317f, -0.494298f,
     0.0998172f, -0.428826f, -0.0168467f, -0.0670923f, 0.145163f, -0.276658f}, {0U}},
    {141.084f, 190.067f, 131.111f, 188.847f, {0.111388f, -0.0177325f, -0.00562332f, -0.19488f, 29.9798f,
     -0.559477f, 0.135824f, -0.558401f, 0.0511007f, -0.0617787f, 0.19265f, -0.350696f}, {0U}},
    {37.2188f, 168.166f, 20.9784f, 156.728f, {0.118022f, -0.0259668f, -0.242172f, -0.113957f, 30.0291f,
     -0.790361f, 0.268817f, -0.641068f, 0.0578802f, -0.181758f, 0.139685f, -0.564706f}, {0U}},
    {83.6174f, 169.145f, 68.2789f, 162.714f, {0.117373f, -0.0192349f, -0.245021f, -0.132164f, 30.0093f,
     -0.964315f, 0.25279f, -0.845702f, 0.0533363f, -0.00881255f, 0.125567f, -0.663509f}, {0U}},
    {141.439f, 166.143f, 127.879f, 165.545f, {0.11601f, -0.00659261f, -0.227276f, -0.170793f, 29.9822f,
     -1.11831f, 0.219238f, -1.04616f, 0.06219f, 0.0609949f, 0.102327f, -0.725031f}, {0U}},
    {289.942f, 211.866f, 287.515f, 217.383f, {0.16406f, -0.00840171f, -0.172525f, -0.248125f, 29.9088f,
     -1.24743f, 0.0669235f, -1.11734f, 0.0192172f, -0.0122416f, 0.0260581f, -0.696025f}, {0U}},
    {262.587f, 209.048f, 262.529f, 214.743f, {0.15326f, 0.057514f, -0.165771f, -0.311552f, 29.9647f, -1.12488f,
     0.023187f, -1.09574f, 0.0186275f, -0.223205f, 0.0638392f, -0.51608f}, {0U}},
    {261.237f, 214.028f, 262.079f, 218.448f, {0.163796f, 0.0644254f, -0.169021f, -0.319812f, 29.9368f, -1.04435f,
     0.00464018f, -1.00499f, 0.0193833f, -0.347144f, 0.0476576f, -0.411055f}, {0U}},
    {265.741f, 228.696f, 268.133f, 231.883f, {0.165407f, 0.0705399f, -0.177016f, -0.320971f, 29.9107f,
     -0.977392f, -0.0204846f, -0.903119f, 0.0107047f, -0.427725f, 0.0373812f, -0.327001f}, {0U}},
    {159.626f, 280.687f, 159.616f, 273.58f, {0.0716973f, 0.0984065f, -0.280476f, -0.416957f, 29.8462f,
     -0.808766f, 0.0342687f, -0.883499f, -0.0154032f, -0.535274f, 0.0759855f, -0.374115f}, {0U}},
    {191.99f, 244.972f, 192.779f, 241.654f, {0.11499f, 0.0580334f, -0.28006f, -0.400101f, 29.8545f, -0.794129f,
     0.038514f, -1.09291f, -0.0231335f, -0.34715f, 0.0352694f, -0.565729f}, {0U}},
    {220.493f, 239.476f, 222.425f, 239.19f, {0.116441f, 0.052364f, -0.290063f, -0.41034f, 29.8346f, -0.778897f,
     0.0111912f, -1.16059f, -0.0318123f, -0.222764f, 0.0211262f, -0.651684f}, {0U}},
    {287.823f, 266.967f, 293.327f, 269.188f, {0.119344f, 0.0743741f, -0.285798f, -0.356194f, 29.739f, -0.749989f,
     -0.0368827f, -1.08599f, -0.0653944f, -0.10396f, 0.00469478f, -0.665887f}, {0U}},
    {371.332f, 259.149f, 381.569f, 266.282f, {0.106198f, -0.117713f, -0.218449f, -0.268895f, 29.7599f,
     -0.508969f, -0.124365f, -0.855917f, -0.0290389f, 0.00252567f, -0.149724f, -0.542138f}, {0U}},
    {354.673f, 199.03f, 358.373f, 209.641f, {0.154291f, -0.107167f, -0.190833f, -0.202342f, 29.7192f, -0.237666f,
     -0.151586f, -0.41545f, 0.0148567f, 0.086301f, -0.16475f, -0.222794f}, {0U}},
    {322.385f, 206.739f, 325.895f, 215.057f, {0.151612f, -0.0893309f, -0.195892f, -0.136046f, 29.7133f,
     -0.0305138f, -0.161972f, -0.1435f, 0.0170142f, -0.0207238f, -0.17032f, 0.107713f}, {0U}},
    {300.389f, 169.936f, 302.461f, 180.33f, {0.126825f, -0.0445468f, -0.16412f, -0.000878081f, 29.8021f,
     0.12962f, -0.140603f, -0.0035353f, 0.0264007f, 0.0675222f, -0.157271f, 0.24845f}, {0U}},
    {301.194f, 201.693f, 304.424f, 210.078f, {0.146106f, 0.00581383f, -0.163279f, 0.0492219f, 29.7516f,
     0.173228f, -0.17137f, 0.276491f, 0.0164324f, -0.098781f, -0.101108f, 0.479902f}, {0U}},
    {273.428f, 208.054f, 275.578f, 213.981f, {0.146251f, 0.0178317f, -0.162048f, 0.109383f, 29.7559f, 0.286024f,
     -0.164458f, 0.500685f, 0.0139629f, -0.139163f, -0.0891104f, 0.670812f}, {0U}},
    {247.784f, 240.671f, 250.54f, 241.852f, {0.138764f, -0.0308456f, -0.195945f, 0.165813f, 29.7536f, 0.336692f,
     -0.144912f, 0.626689f, 0.00143104f, -0.171245f, -0.0833142f, 0.732536f}, {0U}},
    {215.083f, 207.55f, 213.166f, 205.8f, {0.158252f, 0.00951771f, -0.162839f, 0.17305f, 29.7166f, 0.448568f,
     -0.0851817f, 0.703722f, 0.00319969f, -0.177323f, -0.107452f, 0.733636f}, {0U}},
    {227.169f, 227.693f, 228.031f, 227.729f, {0.0598653f, 0.194017f, -0.0903287f, -0.165734f, 29.9718f, -0.7115f,
     -0.0803009f, 0.0194227f, 0.11032f, -1.14068f, 0.0405917f, 0.476592f}, {0U}},
    {229.982f, 241.711f, 232.197f, 240.417f, {0.0647157f, 0.223907f, -0.0944721f, -0.142042f, 29.954f,
     -0.678454f, -0.0798153f, 0.0459885f, 0.081803f, -1.12541f, 0.0525065f, 0.476397f}, {0U}},
    {153.64f, 336.757f, 158.725f, 324.903f, {0.213718f, -0.318465f, 0.0433136f, 0.106247f, 29.9788f, 0.504544f,
     30.0f, 0.473293f, -0.155792f, 0.532497f, 0.265302f, 0.0424959f}, {0U}},
    {228.992f, 140.578f, 227.517f, 146.328f, {0.0605161f, -0.206657f, 0.0487073f, -0.183203f, 30.014f, 0.707037f,
     -0.125445f, 0.192459f, -0.0635693f, 0.840496f, -0.0468382f, -0.461591f}, {0U}},
    {224.966f, 340.754f, 232.936f, 336.612f, {0.145071f, -0.180158f, 0.122172f, 0.0299112f, 29.9875f,
     -0.0116266f, -0.0235917f, 0.0387237f, -0.08102f, 0.109933f, 0.101083f, 0.527767f}, {0U}},
    {219.348f, 299.18f, 224.532f, 297.313f, {0.140567f, -0.217698f, 0.12292f, 0.0368406f, 29.9872f, 0.194475f,
     -0.0226236f, 0.0792539f, -0.0782717f, 0.366751f, 0.114277f, 0.286557f}, {0U}},
    {218.094f, 214.242f, 211.343f, 210.794f, {0.0925682f, -0.0776227f, 0.0715494f, -0.0922191f, 30.0403f,
     0.026723f, 0.0672076f, -0.0880361f, -0.120844f, -0.158933f, -0.11025f, 0.00248464f}, {0U}},
    {234.781f, 180.963f, 232.099f, 185.379f, {0.149343f, 0.120503f, 0.0643419f, -0.215725f, 29.9882f, -0.654265f,
     0.0349868f, -0.568779f, 0.0337805f, -0.331303f, 0.151479f, -0.189309f}, {0U}},
    {1200.0f, 212.718f, 212.718f, 212.718f, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, -6.99072e-7f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0U}}
};

/* The natural size of an error in each field of the memory. */
static const quadrotor_jsse_controller_state_t sizes = {1.0f, 1.0f, 1.0f, 1.0f, {0.1f, 0.1f, 0.1f, 0.1f, 0.1f,
     0.1f, 0.1f, 0.1f, 0.1f, 0.1f, 0.1f, 0.1f}, {0U}};

static const quadrotor_jsse_controller_params_t parameters[] = {
    {212.718f, 212.718f, 212.718f, 212.718f, {0.1f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f, 177.0f,
     74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f, -8.9f,
     13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f, -32.0f,
     -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {-1.0e-45f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {297.068f, 218.545f, 219.983f, 208.473f, {0.0709064f, 0.0f, 0.0f, 0.0f, 0.0f, 25.2973f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 40.2383f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     191.86f, 265.95f, 270.794f, 162.09f, {-20.2202f, -5.02998f, -339.241f, -228.999f, 202.099f, 98.1984f,
     884.883f, 62.0367f, 26.9927f, 4.63957f, 186.17f, 96.4284f, 414.769f, 236.588f, -22.4299f, -27.7574f,
     179.739f, 113.472f, 60.4409f, 2.74868f, 626.321f, 67.3765f, -238.034f, -95.5358f, -11.4775f, 16.37f,
     -398.215f, -383.77f, 253.475f, 79.486f, 915.432f, 93.6335f, 77.7527f, 18.222f, 238.157f, 85.5602f, 374.823f,
     364.019f, -43.1821f, -50.1253f, 261.28f, 103.508f, 134.235f, 19.2029f, 891.344f, 41.4211f, -168.056f, -73.975f}}},
    {202.318f, 175.799f, 269.109f, 173.441f, {0.138997f, 0.0f, 0.0f, 0.0f, 0.0f, 33.3976f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 21.4156f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     287.073f, 284.617f, 268.86f, 223.369f, {-32.4556f, -3.62578f, -337.071f, -274.933f, 146.208f, 91.9308f,
     888.095f, 59.9342f, 25.574f, 3.44008f, 219.832f, 86.4104f, 319.607f, 356.934f, -16.7817f, -30.4675f,
     243.408f, 71.8866f, 51.5519f, 2.1886f, 809.453f, 90.5874f, -140.385f, -61.997f, -7.89618f, 14.7791f,
     -445.094f, -381.498f, 167.289f, 111.325f, 834.535f, 69.9573f, 129.579f, 16.6754f, 140.9f, 60.3453f,
     536.807f, 235.161f, -25.4893f, -42.8156f, 171.407f, 121.436f, 120.927f, 14.5275f, 605.176f, 41.7434f,
     -231.515f, -57.1363f}}},
    {167.14f, 208.359f, 277.224f, 219.604f, {0.0783771f, 0.0f, 0.0f, 0.0f, 0.0f, 21.31f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 32.8505f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 178.152f,
     192.121f, 274.812f, 189.701f, {-27.3845f, -3.56818f, -250.457f, -285.5f, 226.7f, 98.3405f, 647.795f,
     39.5511f, 33.0409f, 4.35773f, 209.731f, 93.6722f, 290.635f, 261.356f, -26.3318f, -24.5807f, 162.096f,
     89.9977f, 55.7441f, 3.77102f, 615.39f, 81.4767f, -135.802f, -56.5881f, -9.97207f, 16.9854f, -405.214f,
     -382.09f, 169.829f, 76.1559f, 909.285f, 73.8367f, 83.2366f, 10.53f, 133.335f, 101.242f, 387.963f, 340.953f,
     -39.4525f, -32.507f, 274.958f, 115.786f, 145.959f, 17.3758f, 560.64f, 44.857f, -220.054f, -59.3229f}}},
    {1200.0f, 212.718f, 212.718f, 212.718f, {0.1f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f, 177.0f,
     74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f, -8.9f,
     13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f, -32.0f,
     -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.1f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}, {12000.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {(float)NAN, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.1f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     1000.0f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f, 177.0f,
     74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f, -8.9f,
     13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f, -32.0f,
     -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}}
};

static const quadrotor_jsse_controller_step_in_t step_inputs[] = {
    {true, {0.179934f, 0.160842f, -0.0433805f, -0.0865567f, 30.1111f, -0.270316f, 0.0577164f, -0.110845f,
     0.0120829f, 0.0332726f, 0.224378f, -0.113015f}},
    {true, {0.177896f, -0.029152f, -0.125159f, -0.131083f, 30.0881f, -0.242528f, 0.289911f, -0.117377f,
     -0.00498869f, -0.188156f, 0.177277f, -0.194142f}},
    {true, {-0.0295358f, 0.088797f, 0.100879f, -0.151622f, 29.9466f, -0.411825f, 0.150915f, -0.339743f,
     -0.0938973f, -0.0663807f, 0.211623f, -0.329246f}},
    {false, {0.375239f, -0.216342f, -0.1314f, -0.120133f, 30.3065f, -0.61116f, 0.165556f, -0.455766f, 0.158675f,
     -0.114542f, 0.193798f, -0.386103f}},
    {true, {0.123267f, -0.152145f, 0.0402321f, -0.29682f, 29.9165f, -0.563863f, 0.210541f, -0.588831f, 0.162431f,
     -0.0658237f, 0.279641f, -0.368357f}},
    {true, {0.12152f, -0.035533f, -0.356694f, -0.0650586f, 30.0604f, -0.855424f, 0.341458f, -0.617636f,
     0.0619949f, -0.207645f, 0.117837f, -0.637283f}},
    {true, {0.0731268f, -0.0980119f, -0.110275f, -0.103696f, 30.006f, -0.99323f, 0.18257f, -0.937592f, 0.128811f,
     0.0600066f, 0.233727f, -0.650977f}},
    {true, {0.110677f, 0.0252445f, -0.100085f, -0.276461f, 29.9642f, -1.09524f, 0.144252f, -1.17076f, 0.117022f,
     0.171253f, 0.0621269f, -0.588532f}},
    {true, {0.216702f, -0.021465f, -0.108083f, -0.304852f, 29.8592f, -1.25232f, -0.0708238f, -1.02851f,
     -0.0293673f, 0.0207261f, -0.0374251f, -0.624919f}},
    {true, {0.133396f, 0.167393f, -0.141467f, -0.386962f, 30.128f, -1.09135f, -0.00645327f, -1.12881f,
     0.0180955f, -0.262791f, 0.167339f, -0.449506f}},
    {true, {0.262242f, 0.0722365f, -0.119901f, -0.335939f, 29.9393f, -0.856124f, 0.10037f, -1.11333f, 0.0879443f,
     -0.356099f, 0.0121695f, -0.281687f}},
    {true, {0.0776496f, -0.0156994f, -0.14748f, -0.310442f, 29.8119f, -0.955937f, -0.0740318f, -0.902187f,
     0.170671f, -0.405576f, 0.0373631f, -0.501484f}},
    {true, {-0.0000710582f, 0.11684f, -0.352216f, -0.494394f, 29.8161f, -0.750785f, 0.0923995f, -0.957175f,
     -0.0269907f, -0.598568f, 0.11115f, -0.462583f}},
    {true, {0.235308f, -0.0505151f, -0.248118f, -0.321588f, 29.9386f, -0.84462f, 0.116106f, -1.11347f,
     -0.00648086f, -0.473183f, -0.0571452f, -0.54444f}},
    {false, {0.244807f, 0.0266761f, -0.0651581f, -0.308433f, 29.8744f, -0.978992f, -0.193581f, -1.02454f,
     -0.0307085f, -0.122622f, -0.0291945f, -0.546325f}},
    {true, {0.122474f, 0.135452f, -0.257279f, -0.24316f, 29.5896f, -0.777125f, -0.074308f, -0.985773f,
     -0.120402f, -0.00303787f, 0.0044212f, -0.631141f}},
    {true, {0.0950558f, -0.239743f, -0.161831f, -0.21557f, 29.7894f, -0.461547f, -0.169162f, -0.816085f,
     -0.000115578f, 0.0232737f, -0.252019f, -0.486418f}},
    {true, {0.28096f, -0.066634f, -0.105608f, -0.215798f, 29.6499f, -0.361743f, -0.16604f, -0.463316f, 0.123646f,
     0.0331031f, -0.168406f, -0.129163f}},
    {false, {0.259776f, -0.15478f, -0.0583164f, -0.144436f, 29.8096f, -0.118833f, -0.0901243f, -0.0944459f,
     -0.172748f, 0.0218668f, -0.0754251f, 0.00558719f}},
    {true, {0.106f, -0.019485f, -0.131643f, 0.0662905f, 29.8848f, 0.13463f, -0.11756f, -0.0901422f, 0.0355459f,
     0.204612f, -0.147709f, 0.161765f}},
    {true, {0.180176f, 0.0637769f, -0.161838f, 0.0597518f, 29.6618f, 0.11109f, -0.22262f, 0.426005f,
     -0.00303983f, -0.215689f, -0.0176641f, 0.477296f}},
    {true, {0.287169f, 0.0139909f, -0.258402f, 0.100392f, 29.714f, 0.172256f, -0.119913f, 0.433202f, 0.132535f,
     -0.0719904f, -0.134723f, 0.684554f}},
    {true, {0.117235f, -0.187722f, -0.295358f, 0.178192f, 29.728f, 0.270012f, -0.125838f, 0.54733f, -0.0231374f,
     -0.186914f, -0.113097f, 0.576126f}},
    {true, {0.203508f, 0.0899995f, -0.0981418f, 0.0856036f, 29.6152f, 0.525759f, 0.0132525f, 0.694308f,
     0.0167145f, -0.289377f, -0.202285f, 0.702556f}},
    {true, {-0.0228055f, 0.123347f, 0.0288868f, -0.20164f, 29.8828f, -0.692613f, -0.0651269f, -0.00223052f,
     0.116969f, (float)NAN, -0.082309f, 0.387707f}},
    {true, {0.0201309f, -0.323944f, 0.0313228f, 0.208705f, 29.6985f, 0.832672f, -0.0259734f, 0.258605f,
     -0.0413435f, 0.964407f, 0.00146315f, -0.279084f}},
    {true, {0.058228f, -0.0349921f, 0.0590571f, -0.344185f, 30.1897f, 0.454833f, -0.0503611f, 0.259726f,
     0.229209f, 0.77458f, 0.135685f, -0.405938f}},
    {true, {0.212289f, 1000000.0f, -0.0267868f, 0.043927f, 29.9507f, 0.280403f, -0.0274691f, -0.064223f,
     -0.168374f, 0.345095f, 0.113198f, 0.567886f}},
    {true, {-0.0250991f, -0.108224f, -0.0741561f, -0.329227f, 29.9052f, 0.172897f, -0.0426492f, -0.293193f,
     0.0562838f, 0.390533f, 0.0618291f, -0.750601f}},
    {true, {0.127938f, 0.00153547f, 0.212832f, -0.359646f, 29.8797f, -0.479822f, 0.00833657f, -0.543913f,
     0.0332979f, -0.469516f, -0.0335711f, 0.0422039f}},
    {true, {0.125362f, -0.00458235f, -0.020016f, 0.278074f, 30.0231f, -0.120583f, 0.00399799f, 0.0240818f,
     -0.0607618f, -0.0778206f, 0.0162175f, 0.186327f}}
};

static const quadrotor_jsse_controller_step_out_t step_outputs[] = {
    {{(quadrotor_jsse_controller_status_t)0, {{0.179934f, 0.160842f, -0.0433805f, -0.0865567f, 0.111099f,
     -0.270315f, 0.0577164f, -0.110845f, 0.0120829f, 0.0332726f, 0.224378f, -0.113015f}, 0.233022f, 0.570857f}},
     {157.985f, 150.566f, 151.571f, 152.192f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0728836f, -0.122373f, -0.0991596f, -0.0776346f, 0.028558f,
     0.0300536f, 0.258545f, 0.00586743f, -0.0123611f, -0.10761f, 0.0508019f, -0.133694f}, 0.136934f, 0.269719f}},
     {107.82f, 168.19f, 99.3243f, 163.133f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.155711f, 0.0267184f, 0.155483f, -0.0670005f, -0.113988f,
     -0.00507904f, 0.0528565f, -0.075592f, -0.0951965f, 0.0415046f, 0.0738587f, -0.168037f}, 0.119627f,
     0.164071f}}, {137.343f, 204.484f, 131.482f, 199.285f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {162.748f, 206.562f, 158.29f, 203.475f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0193085f, -0.218472f, 0.0745329f, -0.165692f, -0.102843f,
     -0.0071294f, 0.121444f, -0.0494605f, 0.180955f, -0.00657465f, 0.141394f, -0.028706f}, 0.162539f,
     0.384762f}}, {141.084f, 190.067f, 131.111f, 188.847f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0105753f, -0.0289186f, -0.346199f, 0.147819f, 0.0945877f,
     -0.196684f, 0.219594f, 0.0708349f, 0.0124387f, -0.0782547f, -0.0660456f, -0.219398f}, 0.302299f,
     0.669202f}}, {37.2188f, 168.166f, 20.9784f, 156.728f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.044246f, -0.078777f, 0.134746f, 0.0284685f, -0.00334087f,
     -0.0289152f, -0.0702203f, -0.09189f, 0.0754748f, 0.0688191f, 0.10816f, 0.0125317f}, 0.0636404f, 0.0f}},
     {83.6174f, 169.145f, 68.2789f, 162.714f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.00621513f, 0.0371058f, 0.14824f, -0.123155f, -0.0209933f,
     0.0268912f, -0.0873955f, -0.145216f, 0.063906f, 0.128504f, -0.0468524f, 0.159088f}, 0.116549f, 0.14199f}},
     {141.439f, 166.143f, 127.879f, 165.545f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.100857f, -0.0250277f, 0.123463f, -0.108683f, -0.0950433f,
     -0.00936493f, -0.263908f, 0.170179f, -0.0930822f, 0.0631623f, -0.121626f, 0.136231f}, 0.191588f,
     0.478047f}}, {289.942f, 211.866f, 287.515f, 217.383f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.030454f, 0.168462f, 0.0372611f, -0.115615f, 0.250386f,
     0.0514058f, -0.0454433f, -0.050703f, -0.00081566f, -0.0606921f, 0.158682f, 0.102069f}, 0.153316f,
     0.347751f}}, {262.587f, 209.048f, 262.529f, 214.743f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.107544f, 0.00853294f, 0.0536588f, -0.017617f, 0.00272184f,
     0.205624f, 0.104576f, -0.118355f, 0.0748969f, -0.00978256f, -0.0387677f, 0.141323f}, 0.109241f,
     0.0845953f}}, {261.237f, 214.028f, 262.079f, 218.448f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.087757f, -0.0862393f, 0.0295363f, 0.010529f, -0.0987921f,
     0.0214549f, -0.0535472f, 0.000931634f, 0.159966f, 0.0221486f, -0.0000181258f, -0.174483f}, 0.0857344f,
     0.0f}}, {265.741f, 228.696f, 268.133f, 231.883f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.167242f, 0.0429555f, -0.167176f, -0.180451f, -0.0701659f,
     0.135114f, 0.135462f, -0.171688f, -0.0270023f, -0.147494f, 0.0819438f, -0.206156f}, 0.23303f, 0.57087f}},
     {159.626f, 280.687f, 159.616f, 273.58f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.161151f, -0.145387f, 0.0427819f, 0.105158f, 0.112619f,
     -0.0676264f, 0.103925f, -0.0275401f, 0.0223042f, -0.168806f, -0.123778f, 0.0285145f}, 0.133938f,
     0.253383f}}, {191.99f, 244.972f, 192.779f, 241.654f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {220.493f, 239.476f, 222.425f, 239.19f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0047239f, 0.0921822f, 0.0430425f, 0.170597f, -0.225528f,
     -0.0409558f, -0.0564844f, 0.151247f, -0.0830206f, 0.152317f, -0.0004129f, 0.0524402f}, 0.150926f,
     0.337422f}}, {287.823f, 266.967f, 293.327f, 269.188f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.0261476f, -0.286382f, 0.132872f, 0.125145f, 0.0691495f,
     0.11129f, -0.10513f, 0.0934791f, 0.0678778f, 0.0486918f, -0.240067f, 0.130764f}, 0.234682f, 0.573891f}},
     {371.332f, 259.149f, 381.569f, 266.282f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.177705f, 0.0568641f, 0.119563f, -0.0188777f, -0.0972745f,
     -0.174069f, -0.0202771f, -0.0671519f, 0.152622f, -0.074632f, -0.00512854f, 0.131356f}, 0.140291f,
     0.287197f}}, {354.673f, 199.03f, 358.373f, 209.641f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {322.385f, 206.739f, 325.895f, 215.057f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.0433787f, 0.0522047f, 0.0676502f, 0.139915f, 0.172262f,
     0.0104355f, 0.0479995f, -0.180406f, 0.0190498f, 0.285564f, 0.0199182f, -0.180568f}, 0.208304f, 0.519933f}},
     {300.389f, 169.936f, 302.461f, 180.33f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0544647f, 0.0926608f, 0.00230396f, 0.0168333f, -0.143539f,
     -0.0993341f, -0.0819286f, 0.239016f, -0.0311286f, -0.186891f, 0.133396f, -0.00416626f}, 0.159862f,
     0.374459f}}, {301.194f, 201.693f, 304.424f, 210.078f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.140918f, -0.00384077f, -0.0963535f, -0.00899075f, -0.0419303f,
     -0.113768f, 0.0445447f, -0.0674835f, 0.118572f, 0.0671722f, -0.0456125f, 0.013742f}, 0.0713177f, 0.0f}},
     {273.428f, 208.054f, 275.578f, 213.981f}},
    {{(quadrotor_jsse_controller_status_t)0, {{-0.0294618f, -0.214681f, -0.136045f, 0.0169409f, -0.0350494f,
     -0.0912494f, 0.0261029f, -0.1086f, -0.0336212f, -0.0214429f, -0.0407569f, -0.214043f}, 0.136847f,
     0.269258f}}, {247.784f, 240.671f, 250.54f, 241.852f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0655152f, 0.116509f, 0.0936579f, -0.126591f, -0.146816f,
     0.111745f, 0.142497f, -0.0136288f, 0.0195646f, -0.162213f, -0.137284f, -0.0449932f}, 0.144764f, 0.309221f}},
     {215.083f, 207.55f, 213.166f, 205.8f}},
    {{(quadrotor_jsse_controller_status_t)-1, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {229.982f, 241.711f, 232.197f, 240.417f}},
    {{(quadrotor_jsse_controller_status_t)0, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f}},
    {{(quadrotor_jsse_controller_status_t)-4, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {219.348f, 299.18f, 224.532f, 297.313f}},
    {{(quadrotor_jsse_controller_status_t)-4, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {212.718f, 212.718f, 212.718f, 212.718f}}
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
    quadrotor_jsse_controller_status_t status;
};

static const struct vector vectors[] = {
    { ENTRY_INIT, 0, 0, 0, 1, 0, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 1, 0, 0, 2, 0, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 2, 1, 0, 3, 1, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 3, 2, 0, 4, 2, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 4, 3, 0, 5, 3, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 5, 4, 0, 6, 4, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 6, 5, 0, 7, 5, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 7, 6, 0, 8, 6, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 8, 7, 0, 9, 7, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 9, 8, 0, 10, 8, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 10, 9, 0, 11, 9, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 11, 10, 0, 12, 10, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 12, 11, 0, 13, 11, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 13, 12, 0, 14, 12, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 14, 13, 0, 15, 13, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 15, 14, 0, 16, 14, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 16, 15, 0, 17, 15, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 17, 16, 0, 18, 16, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 18, 17, 0, 19, 17, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 19, 18, 0, 20, 18, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 20, 19, 0, 21, 19, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 21, 20, 0, 22, 20, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 22, 21, 0, 23, 21, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 23, 22, 0, 24, 22, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 24, 23, 0, 25, 23, QUADROTOR_JSSE_CONTROLLER_OK },
    { ENTRY_STEP, 26, 24, 0, 27, 24, QUADROTOR_JSSE_CONTROLLER_SKIPPED },
    { ENTRY_STEP, 28, 25, 0, 28, 25, QUADROTOR_JSSE_CONTROLLER_OVERFLOW },
    { ENTRY_INIT, 0, 0, 1, 0, 0, QUADROTOR_JSSE_CONTROLLER_BAD_PARAM },
    { ENTRY_STEP, 29, 26, 2, 29, 25, QUADROTOR_JSSE_CONTROLLER_OVERFLOW },
    { ENTRY_STEP, 30, 27, 0, 31, 26, QUADROTOR_JSSE_CONTROLLER_SKIPPED },
    { ENTRY_STEP, 32, 28, 3, 32, 25, QUADROTOR_JSSE_CONTROLLER_OVERFLOW },
    { ENTRY_STEP, 33, 29, 4, 33, 25, QUADROTOR_JSSE_CONTROLLER_OVERFLOW },
    { ENTRY_INIT, 0, 0, 5, 0, 0, QUADROTOR_JSSE_CONTROLLER_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 6, 0, 0, QUADROTOR_JSSE_CONTROLLER_BAD_PARAM },
    { ENTRY_STEP, 34, 30, 0, 34, 25, QUADROTOR_JSSE_CONTROLLER_BAD_INPUT },
    { ENTRY_STEP, 1, 30, 7, 35, 27, QUADROTOR_JSSE_CONTROLLER_SKIPPED },
    { ENTRY_STEP, 1, 30, 8, 1, 25, QUADROTOR_JSSE_CONTROLLER_OVERFLOW }
};

static int differs(float value, float expected, float size)
{
    const int both_nan = (value != value) && (expected != expected);

    return !both_nan && !(fabsf(value - expected) <= (0.002f * (fabsf(expected) + size)));
}

static int memory_differs(const quadrotor_jsse_controller_state_t *state,
     const quadrotor_jsse_controller_state_t *wanted)
{
    int count = 0;

    count += differs(state->delay_estimator_rotor_1, wanted->delay_estimator_rotor_1, sizes.delay_estimator_rotor_1);
    count += differs(state->delay_estimator_rotor_2, wanted->delay_estimator_rotor_2, sizes.delay_estimator_rotor_2);
    count += differs(state->delay_estimator_rotor_3, wanted->delay_estimator_rotor_3, sizes.delay_estimator_rotor_3);
    count += differs(state->delay_estimator_rotor_4, wanted->delay_estimator_rotor_4, sizes.delay_estimator_rotor_4);
    count += differs(state->estimator.x, wanted->estimator.x, sizes.estimator.x);
    count += differs(state->estimator.vx, wanted->estimator.vx, sizes.estimator.vx);
    count += differs(state->estimator.y, wanted->estimator.y, sizes.estimator.y);
    count += differs(state->estimator.vy, wanted->estimator.vy, sizes.estimator.vy);
    count += differs(state->estimator.z, wanted->estimator.z, sizes.estimator.z);
    count += differs(state->estimator.vz, wanted->estimator.vz, sizes.estimator.vz);
    count += differs(state->estimator.roll, wanted->estimator.roll, sizes.estimator.roll);
    count += differs(state->estimator.roll_rate, wanted->estimator.roll_rate, sizes.estimator.roll_rate);
    count += differs(state->estimator.pitch, wanted->estimator.pitch, sizes.estimator.pitch);
    count += differs(state->estimator.pitch_rate, wanted->estimator.pitch_rate, sizes.estimator.pitch_rate);
    count += differs(state->estimator.yaw, wanted->estimator.yaw, sizes.estimator.yaw);
    count += differs(state->estimator.yaw_rate, wanted->estimator.yaw_rate, sizes.estimator.yaw_rate);
    return count;
}

/* Every status has a sentence of its own, and so has a value that is none; the model has its hash. */
static int texts_are_wrong(void)
{
    static const quadrotor_jsse_controller_status_t known[] = {
        QUADROTOR_JSSE_CONTROLLER_OK,
        QUADROTOR_JSSE_CONTROLLER_GATED,
        QUADROTOR_JSSE_CONTROLLER_CLAMPED,
        QUADROTOR_JSSE_CONTROLLER_SKIPPED,
        QUADROTOR_JSSE_CONTROLLER_RECOVERED,
        QUADROTOR_JSSE_CONTROLLER_BAD_INPUT,
        QUADROTOR_JSSE_CONTROLLER_BAD_PARAM,
        QUADROTOR_JSSE_CONTROLLER_NOT_POSITIVE,
        QUADROTOR_JSSE_CONTROLLER_OVERFLOW
    };
    const char *const unknown = quadrotor_jsse_controller_status_text((quadrotor_jsse_controller_status_t)127);
    int wrong = (strcmp(quadrotor_jsse_controller_model(), "3848e263") != 0);

    for (size_t i = 0; i < (sizeof(known) / sizeof(known[0])); i++)
    {
        wrong += (strcmp(quadrotor_jsse_controller_status_text(known[i]), unknown) == 0);
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
        quadrotor_jsse_controller_state_t state = memories[v->start];
        quadrotor_jsse_controller_status_t status = QUADROTOR_JSSE_CONTROLLER_OK;
        int count = 0;

        switch (v->entry)
        {
            case ENTRY_INIT:
            {
                status = quadrotor_jsse_controller_init(&state, &parameters[v->parameters]);
                break;
            }
            case ENTRY_STEP:
            {
                quadrotor_jsse_controller_step_out_t answer = step_outputs[v->outputs];
                const quadrotor_jsse_controller_step_out_t *const expected =
                    &step_outputs[v->outputs];

                status = quadrotor_jsse_controller_step(&state, &parameters[v->parameters],
     &step_inputs[v->inputs], &answer);
                count += (answer.estimator.status_pose != expected->estimator.status_pose);
                for (int i = 0; i < 12; i++)
                {
                    count += differs(answer.estimator.pose.innovation[i], expected->estimator.pose.innovation[i], 1.0f);
                }
                count += differs(answer.estimator.pose.distance_squared,
     expected->estimator.pose.distance_squared, 1.0f);
                count += differs(answer.estimator.pose.weight, expected->estimator.pose.weight, 1.0f);
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
