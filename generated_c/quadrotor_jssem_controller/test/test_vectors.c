/* Test vectors of quadrotor_jssem_controller with their runner. Written by plantc 0.1.0 from model b00f45d0.
 *
 * Each call starts from a stated memory; what it gives is compared with what the Python model gave, in units of the
 * natural size of each field. Build with quadrotor_jssem_controller.c; returns 0 if all agree. For hosts: it prints.
 */
#include "quadrotor_jssem_controller.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const quadrotor_jssem_controller_state_t memories[] = {
    {0.0f, 0.0f, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {3.14212e-8f, 2.80873e-8f, -7.57538e-9f, -1.51151e-8f, 30.0f,
     -7.46276e-7f, 1.00788e-8f, -1.93565e-8f, 2.10999e-9f, 5.81027e-9f, 3.91823e-8f, -1.97354e-8f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {6.56121e-8f, 2.43577e-8f, -3.15143e-8f, -4.58762e-8f, 30.0f,
     -1.46909e-6f, 6.41703e-8f, -3.01772e-8f, 1.31613e-9f, -1.08523e-8f, 7.20611e-8f, -5.70482e-8f}, {0U}},
    {212.718f, 212.719f, 212.718f, 212.718f, {6.07738e-8f, 4.37963e-8f, -1.40409e-8f, -9.75243e-8f, 30.0f,
     -2.19706e-6f, 9.16826e-8f, -5.55129e-8f, -1.59076e-8f, -5.09945e-9f, 1.09864e-7f, -1.06866e-7f}, {0U}},
    {212.719f, 212.717f, 212.719f, 212.718f, {6.18687e-8f, 3.9895e-8f, -1.6479e-8f, -1.20009e-7f, 30.0f,
     -2.32438e-6f, 9.02948e-8f, -0.0000169963f, -1.60351e-8f, 0.0000169357f, 1.07192e-7f, -9.24037e-7f}, {0U}},
    {212.719f, 212.718f, 212.719f, 212.718f, {9.12973e-8f, 6.5092e-9f, -1.09452e-8f, -2.2536e-7f, 30.0f,
     -2.49779e-6f, -2.829e-7f, 1.77319e-7f, 4.46008e-7f, -2.68188e-7f, 1.49242e-7f, 1.50416e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {1.22819e-7f, 1.14315e-7f, -1.08612e-7f, -1.93983e-7f, 30.0f,
     -2.14469e-6f, -1.84565e-7f, 1.72427e-7f, 4.57101e-7f, -2.89858e-7f, 2.19515e-7f, 3.04716e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {1.43079e-7f, 2.12571e-7f, -1.40443e-7f, -1.98635e-7f, 30.0f,
     -2.91938e-6f, -1.28426e-7f, 1.40552e-7f, 4.82087e-7f, -2.88113e-7f, 3.53611e-7f, 2.98408e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {1.74669e-7f, 3.47337e-7f, -1.70685e-7f, -2.63245e-7f, 30.0f,
     -3.68249e-6f, -7.7322e-8f, 9.57516e-8f, 5.0409e-7f, -2.7275e-7f, 4.48724e-7f, 2.95481e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {2.34801e-7f, 4.78502e-7f, -2.05445e-7f, -3.5387e-7f, 30.0f,
     -4.45506e-6f, -7.12726e-8f, 1.18983e-7f, 4.9207e-7f, -2.6793e-7f, 5.22812e-7f, 2.92522e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {2.82376e-7f, 6.56316e-7f, -2.54888e-7f, -4.81182e-7f, 30.0f,
     -5.22134e-6f, -4.0588e-8f, 1.08672e-7f, 4.91796e-7f, -2.85788e-7f, 6.51761e-7f, 2.9006e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {3.64872e-7f, 8.09257e-7f, -3.01642e-7f, -6.03509e-7f, 30.0f,
     -5.94333e-6f, 2.1572e-8f, 7.79115e-8f, 5.09128e-7f, -2.95384e-7f, 7.4189e-7f, 2.89533e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {4.06893e-7f, 9.46562e-7f, -3.60711e-7f, -7.46769e-7f, 30.0f,
     -6.70886e-6f, 4.69021e-8f, 7.39272e-8f, 5.49817e-7f, -2.97315e-7f, 8.40402e-7f, 2.8132e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {4.33401e-7f, 1.13422e-6f, -4.865e-7f, -9.73003e-7f, 30.0f,
     -7.45039e-6f, 1.27022e-7f, 2.16002e-8f, 5.43141e-7f, -3.46605e-7f, 9.61303e-7f, 2.71383e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {5.29183e-7f, 1.2764e-6f, -5.89226e-7f, -1.17996e-6f, 30.0f,
     -8.22603e-6f, 2.15899e-7f, -1.92003e-8f, 5.43678e-7f, -4.22346e-7f, 1.03352e-6f, 2.64841e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {5.61093e-7f, 1.40974e-6f, -6.18725e-7f, -1.23291e-6f, 30.0f,
     -8.9251e-6f, 2.15419e-7f, -1.92003e-8f, 5.33119e-7f, -4.22346e-7f, 1.09973e-6f, 2.64841e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {6.33872e-7f, 1.6069e-6f, -7.34371e-7f, -1.46851e-6f, 30.0f,
     -9.69856e-6f, 2.64455e-7f, -1.56276e-8f, 5.02749e-7f, -4.20422e-7f, 1.19157e-6f, 2.59203e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {7.0395e-7f, 1.70108e-6f, -8.31115e-7f, -1.72481e-6f, 30.0f,
     -0.0000104337f, 2.93752e-7f, -1.39406e-8f, 5.04556e-7f, -4.3195e-7f, 1.21693e-6f, 2.56252e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {8.30712e-7f, 1.84751e-6f, -9.25964e-7f, -2.03172e-6f, 30.0f,
     -0.0000112329f, 3.315e-7f, -4.11723e-8f, 5.40714e-7f, -4.70051e-7f, 1.26491e-6f, 2.55219e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {8.769e-7f, 1.98012e-6f, -9.76757e-7f, -2.11302e-6f, 30.0f,
     -0.000011932f, 3.30471e-7f, -4.11723e-8f, 5.28963e-7f, -4.70051e-7f, 1.32871e-6f, 2.55219e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {9.63948e-7f, 2.15249e-6f, -1.09749e-6f, -2.40724e-6f, 30.0f,
     -0.0000126943f, 3.83778e-7f, -1.02008e-7f, 5.37948e-7f, -4.1339e-7f, 1.38125e-6f, 2.46644e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {1.07791e-6f, 2.35371e-6f, -1.24105e-6f, -2.74532e-6f, 30.0f,
     -0.000013487f, 4.06148e-7f, -7.49488e-8f, 5.37904e-7f, -4.47838e-7f, 1.46454e-6f, 2.40235e-6f}, {0U}},
    {212.718f, 212.718f, 212.717f, 212.718f, {1.22985e-6f, 2.54498e-6f, -1.42879e-6f, -3.1092e-6f, 30.0f,
     -0.0000142967f, 4.56598e-7f, -1.09647e-7f, 5.76509e-7f, -4.29953e-7f, 1.50822e-6f, 2.34172e-6f}, {0U}},
    {212.719f, 212.719f, 212.719f, 212.719f, {1.33962e-6f, 2.69136e-6f, -1.64384e-6f, -3.48872e-6f, 30.0f,
     -0.0000156813f, 5.00657e-7f, -0.0000173579f, 5.72149e-7f, -0.0000176384f, 1.55011e-6f, 1.38607e-6f}, {0U}},
    {212.719f, 212.72f, 212.719f, 212.72f, {1.48003e-6f, 2.92085e-6f, -1.82101e-6f, -3.93291e-6f, 30.0f,
     -0.0000141483f, 1.49151e-7f, -0.0000173865f, 1.50354e-7f, -0.0000176882f, 1.53477e-6f, 1.29091e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {4.25068e-6f, 1.08192e-7f, -5.70795e-6f, -1.53995e-6f, 30.0f,
     -9.12192e-6f, -1.29119e-6f, -1.87008e-6f, -6.73906e-7f, -1.75218e-6f, 1.34484e-6f, -1.7642e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {4.25338e-6f, -5.70834e-8f, -5.74645e-6f, -1.22329e-6f, 30.0f,
     -9.82099e-6f, -1.33794e-6f, -1.87008e-6f, -7.17711e-7f, -1.75218e-6f, 1.30073e-6f, -1.7642e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {5.37765e-6f, -1.63804e-7f, -7.67092e-6f, -6.38704e-7f, 30.0f,
     -0.0000112806f, -1.81407e-6f, -2.15976e-6f, -1.0796e-6f, -5.35699e-7f, 1.4128e-6f, -2.20217e-6f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {9.24728e-6f, -3.44273e-7f, -0.0000132599f, 2.19527e-6f, 30.0f,
     -0.0000193184f, -2.19549e-6f, -1.57747e-6f, -1.29024e-6f, -2.26174e-6f, 2.62504e-6f, -5.31701e-7f}, {0U}},
    {183.957f, 211.81f, 230.254f, 223.212f, {-0.117804f, -0.0341079f, 0.045868f, 0.119281f, 30.1508f, 0.021593f,
     0.10762f, -0.139936f, 0.0508623f, 0.159243f, -0.00414427f, 0.137594f}, {0U}},
    {1200.0f, 212.718f, 212.718f, 212.718f, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {12000.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}, {0U}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, -6.99072e-7f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0U}}
};

/* The natural size of an error in each field of the memory. */
static const quadrotor_jssem_controller_state_t sizes = {1.0f, 1.0f, 1.0f, 1.0f, {0.1f, 0.1f, 0.1f, 0.1f, 0.1f,
     0.1f, 0.1f, 0.1f, 0.1f, 0.1f, 0.1f, 0.1f}, {0U}};

static const quadrotor_jssem_controller_params_t parameters[] = {
    {212.718f, 212.718f, 212.718f, 212.718f, {0.1f, 0.15f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {297.068f, 218.545f, 219.983f, 208.473f, {0.0709064f, 0.169729f, 0.0f, 0.0f, 0.0f, 0.0f, 38.1277f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 36.8487f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 265.95f, 270.794f, 162.09f, 172.049f, {-27.2701f, -3.55486f, -315.844f, -292.483f, 247.668f, 103.025f,
     685.421f, 76.4165f, 29.4506f, 4.43049f, 178.623f, 52.5751f, 460.934f, 420.145f, -17.9739f, -26.2777f,
     204.885f, 90.0431f, 43.7831f, 2.752f, 1068.62f, 89.2505f, -242.446f, -95.7017f, -11.0066f, 16.6857f,
     -410.145f, -255.552f, 237.821f, 129.969f, 614.006f, 81.3918f, 130.515f, 17.3433f, 166.275f, 86.6156f,
     538.427f, 421.323f, -41.8048f, -40.3138f, 220.057f, 130.305f, 141.963f, 9.99819f, 684.739f, 56.4546f,
     -195.662f, -69.3551f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {-1.0e-45f, 0.15f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {290.8f, 247.93f, 275.09f, 259.006f, {0.136347f, 0.12549f, 0.0f, 0.0f, 0.0f, 0.0f, 35.0455f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 25.1266f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     270.748f, 268.792f, 265.938f, 222.735f, {-22.0415f, -3.14076f, -316.233f, -204.269f, 242.457f, 106.977f,
     647.266f, 42.1083f, 23.8424f, 2.48264f, 236.054f, 73.2722f, 459.353f, 309.772f, -21.3485f, -23.8393f,
     240.79f, 98.7666f, 53.5471f, 2.69474f, 1138.45f, 88.3345f, -174.903f, -88.7756f, -11.0228f, 10.7734f,
     -383.695f, -331.725f, 212.84f, 91.9925f, 1068.35f, 84.6598f, 74.9494f, 13.9732f, 189.853f, 92.6272f,
     477.421f, 289.725f, -42.168f, -39.8922f, 259.82f, 125.664f, 138.681f, 11.2225f, 861.963f, 41.3292f,
     -215.278f, -63.8559f}}},
    {241.218f, 217.187f, 263.994f, 176.862f, {0.1088f, 0.111151f, 0.0f, 0.0f, 0.0f, 0.0f, 26.3469f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 35.5489f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     234.139f, 282.924f, 202.153f, 243.782f, {-17.9184f, -5.2588f, -266.002f, -204.466f, 160.641f, 107.856f,
     758.024f, 72.4f, 21.6826f, 4.35425f, 204.549f, 62.9333f, 499.708f, 405.905f, -15.512f, -19.5033f, 229.441f,
     91.8082f, 72.9046f, 3.11817f, 1097.11f, 55.218f, -228.161f, -77.9188f, -9.46581f, 11.6848f, -286.047f,
     -249.026f, 191.307f, 80.6581f, 637.932f, 92.0082f, 98.2794f, 17.6203f, 170.257f, 81.3153f, 418.727f,
     351.082f, -38.5891f, -43.0952f, 246.694f, 76.2292f, 93.4303f, 13.1212f, 794.556f, 49.7107f, -233.356f,
     -91.4804f}}},
    {1200.0f, 212.718f, 212.718f, 212.718f, {0.1f, 0.15f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.1f, 0.15f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {12000.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {(float)NAN, 0.15f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 212.718f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}},
    {212.718f, 212.718f, 212.718f, 212.718f, {0.1f, 0.15f, 0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f, 30.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f,
     212.718f, 1200.0f, 212.718f, {-25.0f, -4.3f, -311.0f, -277.0f, 199.0f, 93.0f, 711.0f, 56.0f, 28.0f, 3.4f,
     177.0f, 74.0f, 411.0f, 333.0f, -20.0f, -22.0f, 200.0f, 95.0f, 59.0f, 2.9f, 844.0f, 71.0f, -188.0f, -76.0f,
     -8.9f, 13.0f, -322.0f, -299.0f, 199.0f, 93.0f, 766.0f, 67.0f, 97.0f, 15.0f, 177.0f, 74.0f, 399.0f, 311.0f,
     -32.0f, -37.0f, 200.0f, 95.0f, 122.0f, 14.0f, 766.0f, 58.0f, -188.0f, -76.0f}}}
};

static const quadrotor_jssem_controller_step_in_t step_inputs[] = {
    {true, {0.179934f, 0.160842f, -0.0433805f, -0.0865567f, 30.1111f, -0.270316f, 0.0577164f, -0.110845f,
     0.0120829f, 0.0332726f, 0.224378f, -0.113015f}},
    {true, {0.177896f, -0.0225607f, -0.125159f, -0.150276f, 30.0881f, -0.126142f, 0.289911f, -0.0574808f,
     -0.00498869f, -0.0885133f, 0.177277f, -0.19821f}},
    {true, {-0.029371f, 0.103071f, 0.100399f, -0.193626f, 29.9495f, -0.155816f, 0.152412f, -0.136608f,
     -0.0914062f, 0.0310189f, 0.211521f, -0.268613f}},
    {false, {0.375761f, -0.197114f, -0.13293f, -0.17618f, 30.3158f, -0.270686f, 0.172132f, -0.0993203f,
     0.163601f, -0.051386f, 0.195213f, -0.237587f}},
    {true, {0.124269f, -0.128736f, 0.037301f, -0.363685f, 29.9343f, -0.163007f, 0.226028f, -0.121171f, 0.168936f,
     -0.0109933f, 0.284768f, -0.156841f}},
    {true, {0.123107f, -0.00619242f, -0.361297f, -0.149197f, 30.0883f, -0.358571f, 0.368636f, -0.0192058f,
     0.0698706f, -0.0850723f, 0.128252f, -0.358576f}},
    {true, {0.0754479f, -0.0600372f, -0.116982f, -0.216422f, 30.0463f, -0.327858f, 0.224709f, -0.138199f,
     0.139751f, 0.00756668f, 0.25111f, -0.273471f}},
    {true, {0.113947f, 0.0717034f, -0.10961f, -0.416766f, 30.0211f, -0.277703f, 0.206376f, -0.194278f, 0.126651f,
     0.0666211f, 0.0889471f, -0.126918f}},
    {true, {0.221134f, 0.0323959f, -0.121115f, -0.471024f, 29.9365f, -0.315931f, 0.0157122f, 0.0998535f,
     -0.022354f, 0.020717f, 0.000935441f, -0.127198f}},
    {true, {0.139175f, 0.223284f, -0.158653f, -0.565853f, 30.2287f, -0.262642f, 0.108292f, -0.0402958f,
     0.0251085f, -0.0697901f, 0.218143f, -0.0962268f}},
    {true, {0.269418f, 0.131791f, -0.14156f, -0.539261f, 30.0608f, -0.0934493f, 0.242328f, -0.125399f,
     0.0997824f, -0.0391209f, 0.0718051f, -0.0214847f}},
    {true, {0.0863142f, 0.0492859f, -0.174222f, -0.546539f, 29.9524f, -0.263254f, 0.0926242f, -0.0157829f,
     0.190433f, -0.00764956f, 0.103504f, -0.325345f}},
    {true, {0.0102181f, 0.189757f, -0.38486f, -0.771487f, 29.9739f, -0.152563f, 0.281216f, -0.188f, 0.00271992f,
     -0.177088f, 0.181694f, -0.357026f}},
    {true, {0.24742f, 0.0329365f, -0.28769f, -0.645114f, 30.1114f, -0.280968f, 0.324151f, -0.149716f, 0.0337668f,
     -0.277931f, 0.0160378f, -0.240044f}},
    {false, {0.259006f, 0.123006f, -0.112818f, -0.682835f, 30.0613f, -0.433115f, 0.0385585f, 0.00114954f,
     0.0144204f, -0.0479781f, 0.0515984f, -0.155977f}},
    {true, {0.139081f, 0.246099f, -0.314299f, -0.677218f, 29.7902f, -0.275647f, 0.183474f, 0.0132379f,
     -0.0734067f, 0.00713011f, 0.0949728f, -0.208898f}},
    {true, {0.114429f, -0.111418f, -0.229702f, -0.732529f, 30.0025f, -0.137927f, 0.113595f, 0.00645515f,
     0.0471337f, -0.04411f, -0.150911f, -0.112895f}},
    {true, {0.30354f, 0.0817495f, -0.186403f, -0.846356f, 29.871f, -0.360797f, 0.13728f, -0.0981291f, 0.16921f,
     -0.137298f, -0.0579605f, -0.0372337f}},
    {false, {0.286067f, 0.00840352f, -0.154875f, -0.882386f, 30.0308f, -0.326643f, 0.222326f, 0.00428543f,
     -0.131444f, -0.0393861f, 0.0373189f, -0.233009f}},
    {true, {0.13637f, 0.154902f, -0.24665f, -0.774272f, 30.1008f, -0.22958f, 0.197358f, -0.220963f, 0.0753192f,
     0.205801f, -0.0409294f, -0.311461f}},
    {true, {0.214906f, 0.247543f, -0.29786f, -0.871564f, 29.8687f, -0.33434f, 0.0890276f, 0.0966705f, 0.0367632f,
     -0.123066f, 0.0772843f, -0.228953f}},
    {true, {0.326493f, 0.208129f, -0.417707f, -0.926819f, 29.9098f, -0.38782f, 0.183501f, -0.121688f, 0.174654f,
     0.0627223f, -0.0574311f, -0.212619f}},
    {true, {0.161413f, 0.0174616f, -0.480343f, -0.935833f, 29.9098f, -0.36709f, 0.163704f, -0.163951f,
     0.0223491f, -0.0246862f, -0.058234f, -0.440414f}},
    {true, {0.252815f, 0.308289f, -0.310977f, -1.11116f, 29.7811f, -0.190009f, 0.285013f, -0.0988375f,
     0.0662566f, -0.172034f, -0.172836f, -0.328979f}},
    {true, {0.529308f, 0.755504f, -1.05401f, -1.21318f, 29.8414f, -0.145897f, 0.0230342f, 0.167028f, 0.151906f,
     -0.0641254f, 0.252055f, (float)NAN}},
    {true, {0.801352f, 0.944193f, -1.10831f, -1.344f, 29.9859f, -0.269104f, 0.00675257f, -0.0158106f, 0.152351f,
     -0.00178911f, 0.476246f, 0.0876444f}},
    {true, {1.12674f, 1.37569f, -1.76649f, -1.37393f, 29.653f, -0.447551f, 0.147748f, -0.0237406f, -0.110519f,
     -0.141554f, 0.508627f, 0.133524f}},
    {true, {-0.0129173f, 0.0865548f, 0.0700154f, -0.323822f, 29.9465f, -0.206298f, 0.10644f, 0.0172954f,
     -0.0870127f, 0.142765f, 0.210933f, 0.186328f}},
    {true, {0.125362f, -0.00458235f, -0.020016f, 0.278074f, 30.0231f, -0.120583f, 0.00399799f, 0.0240818f,
     -0.0607618f, -0.0778206f, 0.0162175f, 0.186327f}}
};

static const quadrotor_jssem_controller_step_out_t step_outputs[] = {
    {{(quadrotor_jssem_controller_status_t)0, {{0.179934f, 0.160842f, -0.0433805f, -0.0865567f, 0.111099f,
     -0.270315f, 0.0577164f, -0.110845f, 0.0120829f, 0.0332726f, 0.224378f, -0.113015f}, 0.233022f,
     1.74626e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.177896f, -0.0225607f, -0.125159f, -0.150276f, 0.0881005f,
     -0.126141f, 0.289911f, -0.0574808f, -0.00498869f, -0.0885133f, 0.177277f, -0.19821f}, 0.260003f,
     1.88249e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{-0.0293711f, 0.103071f, 0.100399f, -0.193626f, -0.0505008f,
     -0.155814f, 0.152412f, -0.136608f, -0.0914062f, 0.0310189f, 0.211521f, -0.268613f}, 0.253988f,
     1.85463e-7f}}, {212.718f, 212.719f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {212.719f, 212.717f, 212.719f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.124269f, -0.128736f, 0.037301f, -0.363685f, -0.0657005f,
     -0.163005f, 0.226028f, -0.121171f, 0.168936f, -0.010993f, 0.284768f, -0.156843f}, 0.396684f, 2.28788e-7f}},
     {212.719f, 212.718f, 212.719f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.123107f, -0.00619254f, -0.361297f, -0.149197f, 0.0883008f,
     -0.358569f, 0.368636f, -0.019206f, 0.0698702f, -0.085072f, 0.128252f, -0.358579f}, 0.597766f, 2.54728e-7f}},
     {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.0754478f, -0.0600374f, -0.116982f, -0.216422f, 0.0463009f,
     -0.327855f, 0.224709f, -0.138199f, 0.139751f, 0.00756697f, 0.25111f, -0.273474f}, 0.406478f, 2.30645e-7f}},
     {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.113947f, 0.0717031f, -0.10961f, -0.416766f, 0.0210992f,
     -0.277699f, 0.206376f, -0.194278f, 0.126651f, 0.0666214f, 0.0889467f, -0.126921f}, 0.40623f, 2.30599e-7f}},
     {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.221134f, 0.0323954f, -0.121115f, -0.471024f, -0.0634994f,
     -0.315927f, 0.0157123f, 0.0998534f, -0.0223545f, 0.0207173f, 0.000934918f, -0.127201f}, 0.417651f,
     2.32659e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.139175f, 0.223283f, -0.158653f, -0.565853f, 0.228701f,
     -0.262637f, 0.108292f, -0.0402959f, 0.025108f, -0.0697898f, 0.218142f, -0.0962297f}, 0.611565f,
     2.55883e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.269418f, 0.13179f, -0.14156f, -0.539261f, 0.0608007f,
     -0.0934434f, 0.242328f, -0.125399f, 0.0997819f, -0.0391206f, 0.0718044f, -0.0214876f}, 0.504776f,
     2.45301e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.0863138f, 0.049285f, -0.174222f, -0.546538f, -0.0475996f,
     -0.263247f, 0.0926242f, -0.015783f, 0.190432f, -0.00764926f, 0.103503f, -0.325348f}, 0.572217f,
     2.52443e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.0102177f, 0.189756f, -0.38486f, -0.771486f, -0.0261f,
     -0.152556f, 0.281216f, -0.188f, 0.00271938f, -0.177088f, 0.181693f, -0.357029f}, 1.10965f, 2.78335e-7f}},
     {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.24742f, 0.0329352f, -0.28769f, -0.645113f, 0.111401f,
     -0.28096f, 0.324151f, -0.149716f, 0.0337663f, -0.277931f, 0.0160368f, -0.240047f}, 0.91634f, 2.72519e-7f}},
     {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.13908f, 0.246097f, -0.314298f, -0.677217f, -0.2098f,
     -0.275637f, 0.183474f, 0.0132379f, -0.0734072f, 0.00713053f, 0.0949716f, -0.208901f}, 0.849242f,
     2.69882e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.114428f, -0.11142f, -0.229701f, -0.732527f, 0.00250078f,
     -0.137917f, 0.113595f, 0.00645517f, 0.0471332f, -0.0441096f, -0.150912f, -0.112898f}, 0.686528f,
     2.61344e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.303539f, 0.0817477f, -0.186402f, -0.846354f, -0.128999f,
     -0.360786f, 0.13728f, -0.0981291f, 0.16921f, -0.137298f, -0.0579618f, -0.0372363f}, 1.07739f, 2.77509e-7f}},
     {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.136369f, 0.1549f, -0.246649f, -0.77427f, 0.1008f, -0.229567f,
     0.197358f, -0.220963f, 0.0753187f, 0.205801f, -0.0409308f, -0.311464f}, 1.00027f, 2.7532e-7f}}, {212.718f,
     212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.214905f, 0.247541f, -0.297859f, -0.871561f, -0.1313f,
     -0.334327f, 0.0890272f, 0.0966706f, 0.0367627f, -0.123066f, 0.0772829f, -0.228955f}, 1.17697f,
     2.79912e-7f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.326492f, 0.208127f, -0.417706f, -0.926816f, -0.0902001f,
     -0.387806f, 0.183501f, -0.121688f, 0.174653f, 0.0627228f, -0.0574326f, -0.212621f}, 1.47333f, 2.8514e-7f}},
     {212.718f, 212.718f, 212.717f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.161412f, 0.0174589f, -0.480341f, -0.93583f, -0.0902001f,
     -0.367074f, 0.163704f, -0.163934f, 0.0223485f, -0.0246686f, -0.0582356f, -0.440416f}, 1.52788f,
     2.85881e-7f}}, {212.719f, 212.719f, 212.719f, 212.719f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.252814f, 0.308286f, -0.310975f, -1.11116f, -0.2189f,
     -0.189995f, 0.285013f, -0.0988201f, 0.0662565f, -0.172016f, -0.172838f, -0.32898f}, 1.83742f, 2.89254e-7f}},
     {212.719f, 212.72f, 212.719f, 212.72f}},
    {{(quadrotor_jssem_controller_status_t)-1, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}, 0.0f, 0.0f}}, {212.718f, 212.718f, 212.718f, 212.718f}},
    {{(quadrotor_jssem_controller_status_t)0, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f}, 0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f}},
    {{(quadrotor_jssem_controller_status_t)-4, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}, 0.0f, 0.0f}}, {212.718f, 212.718f, 212.718f, 212.718f}}
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
    quadrotor_jssem_controller_status_t status;
};

static const struct vector vectors[] = {
    { ENTRY_INIT, 0, 0, 0, 1, 0, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 1, 0, 0, 2, 0, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 2, 1, 0, 3, 1, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 3, 2, 0, 4, 2, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 4, 3, 0, 5, 3, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 5, 4, 0, 6, 4, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 6, 5, 0, 7, 5, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 7, 6, 0, 8, 6, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 8, 7, 0, 9, 7, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 9, 8, 0, 10, 8, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 10, 9, 0, 11, 9, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 11, 10, 0, 12, 10, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 12, 11, 0, 13, 11, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 13, 12, 0, 14, 12, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 14, 13, 0, 15, 13, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 15, 14, 0, 16, 14, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 16, 15, 0, 17, 15, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 17, 16, 0, 18, 16, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 18, 17, 0, 19, 17, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 19, 18, 0, 20, 14, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 20, 19, 0, 21, 18, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 21, 20, 0, 22, 19, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 22, 21, 0, 23, 20, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 23, 22, 0, 24, 21, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 24, 23, 0, 25, 22, QUADROTOR_JSSEM_CONTROLLER_OK },
    { ENTRY_STEP, 26, 24, 0, 27, 23, QUADROTOR_JSSEM_CONTROLLER_SKIPPED },
    { ENTRY_STEP, 28, 25, 1, 28, 24, QUADROTOR_JSSEM_CONTROLLER_OVERFLOW },
    { ENTRY_INIT, 0, 0, 2, 0, 0, QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM },
    { ENTRY_STEP, 29, 26, 3, 29, 24, QUADROTOR_JSSEM_CONTROLLER_OVERFLOW },
    { ENTRY_STEP, 30, 27, 4, 30, 24, QUADROTOR_JSSEM_CONTROLLER_OVERFLOW },
    { ENTRY_INIT, 0, 0, 5, 0, 0, QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 6, 0, 0, QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM },
    { ENTRY_STEP, 31, 28, 0, 31, 24, QUADROTOR_JSSEM_CONTROLLER_BAD_INPUT },
    { ENTRY_STEP, 32, 28, 0, 32, 24, QUADROTOR_JSSEM_CONTROLLER_OVERFLOW },
    { ENTRY_STEP, 1, 28, 7, 33, 25, QUADROTOR_JSSEM_CONTROLLER_SKIPPED },
    { ENTRY_STEP, 1, 28, 8, 1, 24, QUADROTOR_JSSEM_CONTROLLER_OVERFLOW }
};

static int differs(float value, float expected, float size)
{
    const int both_nan = (value != value) && (expected != expected);

    return !both_nan && !(fabsf(value - expected) <= (0.002f * (fabsf(expected) + size)));
}

static int memory_differs(const quadrotor_jssem_controller_state_t *state,
     const quadrotor_jssem_controller_state_t *wanted)
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
    static const quadrotor_jssem_controller_status_t known[] = {
        QUADROTOR_JSSEM_CONTROLLER_OK,
        QUADROTOR_JSSEM_CONTROLLER_GATED,
        QUADROTOR_JSSEM_CONTROLLER_CLAMPED,
        QUADROTOR_JSSEM_CONTROLLER_SKIPPED,
        QUADROTOR_JSSEM_CONTROLLER_RECOVERED,
        QUADROTOR_JSSEM_CONTROLLER_BAD_INPUT,
        QUADROTOR_JSSEM_CONTROLLER_BAD_PARAM,
        QUADROTOR_JSSEM_CONTROLLER_NOT_POSITIVE,
        QUADROTOR_JSSEM_CONTROLLER_OVERFLOW
    };
    const char *const unknown = quadrotor_jssem_controller_status_text((quadrotor_jssem_controller_status_t)127);
    int wrong = (strcmp(quadrotor_jssem_controller_model(), "b00f45d0") != 0);

    for (size_t i = 0; i < (sizeof(known) / sizeof(known[0])); i++)
    {
        wrong += (strcmp(quadrotor_jssem_controller_status_text(known[i]), unknown) == 0);
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
        quadrotor_jssem_controller_state_t state = memories[v->start];
        quadrotor_jssem_controller_status_t status = QUADROTOR_JSSEM_CONTROLLER_OK;
        int count = 0;

        switch (v->entry)
        {
            case ENTRY_INIT:
            {
                status = quadrotor_jssem_controller_init(&state, &parameters[v->parameters]);
                break;
            }
            case ENTRY_STEP:
            {
                quadrotor_jssem_controller_step_out_t answer = step_outputs[v->outputs];
                const quadrotor_jssem_controller_step_out_t *const expected =
                    &step_outputs[v->outputs];

                status = quadrotor_jssem_controller_step(&state, &parameters[v->parameters],
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
