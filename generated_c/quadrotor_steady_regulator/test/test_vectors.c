/* Test vectors of quadrotor_steady_regulator with their runner. Written by plantc 0.1.0 from model 16afd8e2.
 *
 * Each call starts from a stated memory; what it gives is compared with what the Python model gave, in units of the
 * natural size of each field. Build with quadrotor_steady_regulator.c; returns 0 if all agree. For hosts: it prints.
 */
#include "quadrotor_steady_regulator.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const quadrotor_steady_regulator_state_t memories[] = {
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {0U}},
    {{{-0.00228202f, -0.001745f, -0.000855265f, -0.000289374f, -0.0000675585f, -0.0000101f, -7.49694e-7f}},
     {{-0.00329743f, -0.00252146f, -0.00123582f, -0.000418134f, -0.0000976193f, -0.0000145941f, -1.08328e-6f}},
     {{0.00150645f, 0.00115195f, 0.000564595f, 0.000191028f, 0.0000445981f, 6.66742e-6f, 4.94903e-7f}},
     {{-0.00118943f, -0.000909524f, -0.000445778f, -0.000150826f, -0.0000352126f, -5.26428e-6f, -3.90753e-7f}}, {0U}},
    {{{0.0000370728f, 0.0000379336f, 0.0000211866f, 7.7755e-6f, 1.92873e-6f, 3.03546e-7f, 2.36447e-8f}},
     {{-0.00211557f, -0.00160387f, -0.000782339f, -0.000263824f, -0.0000614295f, -9.16176e-6f, -6.78445e-7f}},
     {{0.0017155f, 0.00130548f, 0.000638128f, 0.000215507f, 0.0000502381f, 7.50057e-6f, 5.56011e-7f}},
     {{0.000608125f, 0.000470015f, 0.000231718f, 0.0000787173f, 0.0000184367f, 2.76421e-6f, 2.05759e-7f}}, {0U}},
    {{{-0.0072628f, -0.00554425f, -0.00271482f, -0.00091795f, -0.000214198f, -0.0000320078f, -2.37477e-6f}},
     {{-0.005447f, -0.00414245f, -0.00202416f, -0.000683431f, -0.000159289f, -0.0000237779f, -1.76236e-6f}},
     {{0.00232955f, 0.00176782f, 0.000862787f, 0.000291066f, 0.0000677938f, 0.0000101138f, 7.49161e-7f}},
     {{-0.0000793872f, -0.0000582621f, -0.0000278994f, -9.28674e-6f, -2.1399e-6f, -3.16141e-7f, -2.31922e-8f}}, {0U}},
    {{{-0.00737369f, -0.00559855f, -0.00273318f, -0.000922234f, -0.000214838f, -0.0000320553f, -2.37477e-6f}},
     {{-0.00552985f, -0.00418293f, -0.00203783f, -0.000686617f, -0.000159765f, -0.0000238131f, -1.76236e-6f}},
     {{0.00236491f, 0.00178508f, 0.000868608f, 0.000292422f, 0.0000679961f, 0.0000101288f, 7.49161e-7f}},
     {{-0.0000805524f, -0.0000588201f, -0.0000280851f, -9.32954e-6f, -2.14622e-6f, -3.16605e-7f, -2.31922e-8f}}, {0U}},
    {{{-0.00368558f, -0.00274739f, -0.00132741f, -0.000444657f, -0.000102979f, -0.000015284f, -1.12636e-6f}},
     {{-0.00729804f, -0.0055118f, -0.0026829f, -0.000903421f, -0.000210111f, -0.0000313039f, -2.31577e-6f}},
     {{0.0032986f, 0.00248912f, 0.00121101f, 0.000407653f, 0.0000947834f, 0.0000141182f, 1.04417e-6f}},
     {{0.002679f, 0.00205168f, 0.00100641f, 0.000340705f, 0.000079578f, 0.0000119016f, 8.83768e-7f}}, {0U}},
    {{{0.00269914f, 0.00215031f, 0.00107718f, 0.000369872f, 0.0000873596f, 0.0000131948f, 9.89212e-7f}},
     {{-0.009675f, -0.00729877f, -0.0035505f, -0.00119506f, -0.000277843f, -0.0000413825f, -3.06044e-6f}},
     {{-0.00208102f, -0.00163839f, -0.000815692f, -0.000278933f, -0.0000656702f, -9.89093e-6f, -7.3951e-7f}},
     {{0.000390189f, 0.000290235f, 0.000140035f, 0.000046858f, 0.0000108417f, 1.60761e-6f, 1.18362e-7f}}, {0U}},
    {{{0.000576613f, 0.000515925f, 0.00027297f, 0.0000970164f, 0.0000235136f, 3.63015e-6f, 2.77787e-7f}},
     {{-0.0120107f, -0.00904421f, -0.00439508f, -0.00147829f, -0.000343497f, -0.0000511352f, -3.77981e-6f}},
     {{-0.00146015f, -0.00115488f, -0.000576298f, -0.000197361f, -0.0000465173f, -7.01279e-6f, -5.24776e-7f}},
     {{-0.00142833f, -0.00110198f, -0.000542755f, -0.00018426f, -0.0000431346f, -6.46429e-6f, -4.80968e-7f}}, {0U}},
    {{{0.000586931f, 0.000521384f, 0.00027491f, 0.0000974867f, 0.0000235862f, 3.63571e-6f, 2.77787e-7f}},
     {{-0.0121916f, -0.00913211f, -0.00442465f, -0.00148516f, -0.00034452f, -0.0000512108f, -3.77981e-6f}},
     {{-0.00148325f, -0.00116641f, -0.000580245f, -0.000198291f, -0.0000466576f, -7.02329e-6f, -5.24776e-7f}},
     {{-0.00145037f, -0.00111284f, -0.00054644f, -0.000185123f, -0.0000432639f, -6.47391e-6f, -4.80968e-7f}}, {0U}},
    {{{-0.0027696f, -0.00204775f, -0.000985023f, -0.000328993f, -0.0000760189f, -0.0000112606f, -8.28334e-7f}},
     {{-0.0128017f, -0.00954745f, -0.00461455f, -0.00154625f, -0.000358198f, -0.0000531782f, -3.92023e-6f}},
     {{-0.00439896f, -0.00338975f, -0.00166823f, -0.000565996f, -0.000132426f, -0.0000198352f, -1.47499e-6f}},
     {{-0.00115932f, -0.000884187f, -0.000432718f, -0.000146258f, -0.0000341179f, -5.09684e-6f, -3.78038e-7f}}, {0U}},
    {{{-0.00330586f, -0.0024462f, -0.00117723f, -0.000393321f, -0.0000909074f, -0.0000134693f, -9.91052e-7f}},
     {{-0.012515f, -0.00927447f, -0.00446645f, -0.00149284f, -0.00034512f, -0.0000511425f, -3.7633e-6f}},
     {{-0.00737505f, -0.00564702f, -0.00276953f, -0.000937434f, -0.000218922f, -0.0000327365f, -2.43043e-6f}},
     {{-0.00297762f, -0.00226973f, -0.00111049f, -0.00037527f, -0.0000875266f, -0.0000130738f, -9.69581e-7f}}, {0U}},
    {{{-0.0021695f, -0.00156339f, -0.00074087f, -0.000244838f, -0.0000560868f, -8.24317e-6f, -6.0166e-7f}},
     {{-0.0132917f, -0.00981588f, -0.00471788f, -0.00157471f, -0.000363646f, -0.0000538344f, -3.95753e-6f}},
     {{-0.00171284f, -0.0012863f, -0.000623844f, -0.000209488f, -0.0000486052f, -7.22487e-6f, -5.33166e-7f}},
     {{-0.00219644f, -0.00165988f, -0.00080821f, -0.000272206f, -0.0000633177f, -9.43487e-6f, -6.98034e-7f}}, {0U}},
    {{{-0.00220077f, -0.00157821f, -0.000745767f, -0.00024596f, -0.0000562517f, -8.2552e-6f, -6.0166e-7f}},
     {{-0.013488f, -0.00991024f, -0.00474937f, -0.00158198f, -0.000364723f, -0.0000539136f, -3.95753e-6f}},
     {{-0.00173857f, -0.00129878f, -0.000628034f, -0.00021046f, -0.0000487497f, -7.23553e-6f, -5.33166e-7f}},
     {{-0.00222964f, -0.00167604f, -0.000813654f, -0.000273472f, -0.0000635064f, -9.44883e-6f, -6.98034e-7f}}, {0U}},
    {{{-0.00412782f, -0.00304256f, -0.00146109f, -0.000487445f, -0.000112532f, -0.0000166565f, -1.22437e-6f}},
     {{-0.0123266f, -0.00896556f, -0.00427144f, -0.00141687f, -0.00032555f, -0.0000479752f, -3.51086e-6f}},
     {{-0.00187195f, -0.00139347f, -0.000672498f, -0.000225055f, -0.0000520742f, -7.72157e-6f, -5.68452e-7f}},
     {{-0.00255539f, -0.00191577f, -0.000928644f, -0.000311798f, -0.0000723466f, -0.0000107561f, -7.94036e-7f}}, {0U}},
    {{{-0.00362634f, -0.00264178f, -0.00126009f, -0.000418389f, -0.0000962176f, -0.0000141922f, -1.03963e-6f}},
     {{-0.00860788f, -0.00607026f, -0.00283886f, -0.000929086f, -0.000211109f, -0.0000307931f, -2.23027e-6f}},
     {{0.00305769f, 0.00238396f, 0.001181f, 0.000402546f, 0.000094537f, 0.0000142085f, 1.0602e-6f}},
     {{-0.00293825f, -0.00219781f, -0.00106401f, -0.000356936f, -0.0000827619f, -0.0000122969f, -9.07227e-7f}}, {0U}},
    {{{0.00182134f, 0.00153912f, 0.000793047f, 0.000277185f, 0.0000663395f, 0.0000101317f, 7.6741e-7f}},
     {{-0.00978088f, -0.00693116f, -0.00325156f, -0.00106666f, -0.000242857f, -0.0000354919f, -2.57574e-6f}},
     {{0.00158952f, 0.00124845f, 0.000620934f, 0.000212217f, 0.0000499448f, 7.52069e-6f, 5.62209e-7f}},
     {{-0.00566441f, -0.0042701f, -0.00207639f, -0.000698711f, -0.000162414f, -0.0000241862f, -1.78839e-6f}}, {0U}},
    {{{0.00185212f, 0.00155498f, 0.000798591f, 0.000278512f, 0.0000665421f, 0.000010147f, 7.6741e-7f}},
     {{-0.0099195f, -0.00699619f, -0.00327289f, -0.00107152f, -0.000243567f, -0.0000355434f, -2.57574e-6f}},
     {{0.00161449f, 0.00126087f, 0.000625178f, 0.000213216f, 0.0000500952f, 7.53193e-6f, 5.62209e-7f}},
     {{-0.00574981f, -0.00431163f, -0.00209036f, -0.000701959f, -0.000162898f, -0.000024222f, -1.78839e-6f}}, {0U}},
    {{{-0.0020034f, -0.00140105f, -0.000652483f, -0.000213005f, -0.0000483172f, -7.03946e-6f, -5.09431e-7f}},
     {{-0.0108329f, -0.00765309f, -0.0035842f, -0.00117447f, -0.000267176f, -0.0000390181f, -2.82984e-6f}},
     {{-0.00283705f, -0.00214989f, -0.00104837f, -0.000353462f, -0.0000822871f, -0.0000122705f, -9.08504e-7f}},
     {{-0.00127707f, -0.000867308f, -0.00039577f, -0.000127112f, -0.0000284155f, -4.08022e-6f, -2.90668e-7f}}, {0U}},
    {{{0.000344331f, 0.000402578f, 0.000233651f, 0.0000872885f, 0.0000218754f, 3.46519e-6f, 2.71056e-7f}},
     {{-0.00984894f, -0.00685533f, -0.00318155f, -0.00103563f, -0.000234295f, -0.0000340424f, -2.4563e-6f}},
     {{-0.00676735f, -0.00514338f, -0.00251234f, -0.000848042f, -0.000197615f, -0.0000294935f, -2.18557e-6f}},
     {{-0.0000362618f, 0.0000868555f, 0.000073224f, 0.0000318614f, 8.75017e-6f, 1.48243e-6f, 1.22664e-7f}}, {0U}},
    {{{0.00214923f, 0.00178125f, 0.000908826f, 0.000315577f, 0.0000751398f, 0.0000114233f, 8.6136e-7f}},
     {{-0.00694667f, -0.00459483f, -0.00206315f, -0.000654905f, -0.000144996f, -0.0000206396f, -1.4578e-6f}},
     {{-0.00739205f, -0.00559266f, -0.00272488f, -0.000918166f, -0.000213654f, -0.0000318468f, -2.357e-6f}},
     {{0.00396939f, 0.00315001f, 0.00157446f, 0.000539757f, 0.000127314f, 0.0000192058f, 1.43804e-6f}}, {0U}},
    {{{0.00218486f, 0.00179943f, 0.000915138f, 0.00031708f, 0.0000753683f, 0.0000114405f, 8.6136e-7f}},
     {{-0.00703857f, -0.00463609f, -0.00207625f, -0.000657805f, -0.000145409f, -0.0000206688f, -1.4578e-6f}},
     {{-0.0075039f, -0.00564716f, -0.00274324f, -0.000922439f, -0.000214291f, -0.0000318939f, -2.357e-6f}},
     {{0.00403239f, 0.0031815f, 0.00158526f, 0.000542303f, 0.000127698f, 0.0000192346f, 1.43804e-6f}}, {0U}},
    {{{0.00292999f, 0.00235999f, 0.00118725f, 0.000408511f, 0.0000965909f, 0.0000145963f, 1.09433e-6f}},
     {{-0.012612f, -0.00886858f, -0.00414349f, -0.0013557f, -0.000308077f, -0.000044955f, -3.25833e-6f}},
     {{-0.0105893f, -0.00797501f, -0.00387573f, -0.00130365f, -0.000302928f, -0.0000450969f, -3.33353e-6f}},
     {{0.00264631f, 0.00210464f, 0.00105278f, 0.000361024f, 0.0000851643f, 0.0000128471f, 9.61777e-7f}}, {0U}},
    {{{0.00846885f, 0.00658307f, 0.00325361f, 0.00110682f, 0.000259462f, 0.0000389237f, 2.89846e-6f}},
     {{-0.0107897f, -0.00742232f, -0.00342114f, -0.00110829f, -0.000249775f, -0.0000361696f, -2.60138e-6f}},
     {{-0.00953614f, -0.00712523f, -0.00344732f, -0.00115594f, -0.00026793f, -0.0000397965f, -2.93514e-6f}},
     {{0.00144398f, 0.00117411f, 0.000593609f, 0.000204926f, 0.0000485804f, 7.35863e-6f, 5.52955e-7f}}, {0U}},
    {{{0.00414415f, 0.00324047f, 0.00160557f, 0.000546915f, 0.000128311f, 0.0000192582f, 1.43445e-6f}},
     {{-0.00985519f, -0.00666264f, -0.00303743f, -0.000975961f, -0.000218438f, -0.0000314286f, -2.24561e-6f}},
     {{-0.00817178f, -0.00604191f, -0.00290569f, -0.000970218f, -0.000224116f, -0.000033186f, -2.4401e-6f}},
     {{0.007231f, 0.00559321f, 0.00275779f, 0.000936749f, 0.000219355f, 0.0000328785f, 2.4464e-6f}}, {0U}},
    {{{0.00420896f, 0.00327258f, 0.00161651f, 0.000549481f, 0.000128696f, 0.0000192869f, 1.43445e-6f}},
     {{-0.00998844f, -0.00672339f, -0.00305695f, -0.00098033f, -0.000219067f, -0.0000314735f, -2.24561e-6f}},
     {{-0.00829262f, -0.00610002f, -0.00292509f, -0.0009747f, -0.00022478f, -0.0000332348f, -2.4401e-6f}},
     {{0.00734286f, 0.00564837f, 0.00277652f, 0.000941136f, 0.000220013f, 0.0000329274f, 2.4464e-6f}}, {0U}},
    {{{0.0199768f, 0.0143223f, 0.00678894f, 0.00224795f, 0.000516424f, 0.0000761772f, 5.58622e-6f}},
     {{0.00430709f, 0.00257853f, 0.00107976f, 0.000324062f, 0.0000682299f, 9.24167e-6f, 6.18591e-7f}},
     {{0.00794638f, 0.00641747f, 0.00322526f, 0.00110773f, 0.000261351f, 0.0000393954f, 2.94476e-6f}},
     {{0.00200176f, 0.00099641f, 0.000359645f, 0.0000944431f, 0.0000174122f, 2.03864e-6f, 1.14196e-7f}}, {0U}},
    {{{0.0202632f, 0.0144581f, 0.0068339f, 0.00225828f, 0.000517948f, 0.0000762889f, 5.58622e-6f}},
     {{0.00228659f, 0.00101567f, 0.000309663f, 0.0000626756f, 7.07176e-6f, 8.32701e-8f, -6.21294e-8f}},
     {{0.0090755f, 0.00724724f, 0.00362249f, 0.00123986f, 0.000291766f, 0.0000438836f, 3.27353e-6f}},
     {{0.0034421f, 0.00208976f, 0.000893882f, 0.000274908f, 0.0000595039f, 8.32753e-6f, 5.80833e-7f}}, {0U}},
    {{{0.00348497f, -0.00102744f, -0.00136649f, -0.000640536f, -0.00017923f, -0.0000303384f, -2.48067e-6f}},
     {{0.0109206f, 0.0067852f, 0.00295151f, 0.000919789f, 0.00020133f, 0.0000284621f, 2.00417e-6f}},
     {{-0.00929248f, -0.00581398f, -0.00253699f, -0.00079163f, -0.000173302f, -0.0000244793f, -1.72034e-6f}},
     {{0.00397153f, 0.000774314f, -0.000156627f, -0.000165144f, -0.0000574877f, -0.0000108872f, -9.58695e-7f}}, {0U}},
    {{{0.000754631f, -0.00312688f, -0.00239489f, -0.000987739f, -0.000260059f, -0.0000423813f, -3.3709e-6f}},
     {{0.0110563f, 0.00684423f, 0.00296991f, 0.000923816f, 0.000201899f, 0.0000285022f, 2.00417e-6f}},
     {{-0.00836034f, -0.00506302f, -0.00215989f, -0.00066215f, -0.000142753f, -0.0000198735f, -1.37591e-6f}},
     {{-0.000522306f, -0.00267698f, -0.00184995f, -0.000738103f, -0.000191203f, -0.0000308642f, -2.44011e-6f}}, {0U}},
    {{{0.0147359f, 0.00997729f, 0.00457467f, 0.0014801f, 0.000333845f, 0.0000484582f, 3.49916e-6f}},
     {{-0.00622069f, -0.00546952f, -0.00285962f, -0.00100679f, -0.000241973f, -0.00003705f, -2.81019e-6f}},
     {{0.00755655f, 0.00592547f, 0.00293005f, 0.000994968f, 0.000232583f, 0.0000347644f, 2.57668e-6f}},
     {{0.0079827f, 0.00545939f, 0.00252058f, 0.000819976f, 0.000185838f, 0.0000270999f, 1.96645e-6f}}, {0U}},
    {{{0.0190134f, 0.0131871f, 0.00613262f, 0.00200388f, 0.00045554f, 0.0000665767f, 4.83885e-6f}},
     {{-0.00336221f, -0.00325725f, -0.00176744f, -0.000635285f, -0.000154851f, -0.0000239707f, -1.83518e-6f}},
     {{0.00767506f, 0.00598407f, 0.00294995f, 0.00099962f, 0.000233278f, 0.0000348159f, 2.57668e-6f}},
     {{0.00897309f, 0.00618364f, 0.00286724f, 0.000935435f, 0.000212468f, 0.0000310394f, 2.25595e-6f}}, {0U}},
    {{{-0.000438687f, -0.00112329f, -0.000757274f, -0.000303304f, -0.0000794046f, -0.0000129957f, -1.04486e-6f}},
     {{0.00285826f, 0.00209813f, 0.00100541f, 0.00033496f, 0.0000772504f, 0.0000114247f, 8.39169e-7f}},
     {{-0.00419983f, -0.00277138f, -0.00124245f, -0.000393914f, -0.0000871223f, -0.0000123893f, -8.7416e-7f}},
     {{0.00678749f, 0.0048108f, 0.00225803f, 0.000741191f, 0.00016887f, 0.0000246988f, 1.79417e-6f}}, {0U}},
    {{{-0.00074829f, -0.001358f, -0.000870954f, -0.000341303f, -0.0000881651f, -0.0000142874f, -1.13919e-6f}},
     {{0.00112139f, 0.000758013f, 0.000345433f, 0.000110939f, 0.0000248172f, 3.56857e-6f, 2.54785e-7f}},
     {{0.000513215f, 0.000850102f, 0.00053682f, 0.000209015f, 0.0000537991f, 8.69801e-6f, 6.92389e-7f}},
     {{0.00688371f, 0.00485596f, 0.00227285f, 0.000744568f, 0.000169364f, 0.0000247347f, 1.79417e-6f}}, {0U}},
    {{{0.0125042f, 0.00602925f, 0.0021136f, 0.000538319f, 0.0000957105f, 0.0000106653f, 5.51431e-7f}},
     {{0.00408386f, 0.00173908f, 0.000518767f, 0.000104669f, 0.0000122988f, 3.46007e-7f, -7.4061e-8f}},
     {{-0.00682782f, -0.00407229f, -0.00171473f, -0.000519504f, -0.000110714f, -0.0000152256f, -1.03936e-6f}},
     {{0.00622138f, 0.00269553f, 0.000826399f, 0.000174955f, 0.000022988f, 1.24969e-6f, -5.26727e-8f}}, {0U}},
    {{{1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f}}, {{0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}}, {0U}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f,
     1200000.0f, 1200000.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}}, {0U}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{1200000.0f,
     1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}}, {0U}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f,
     1200000.0f}}, {0U}}
};

/* The natural size of an error in each field of the memory. */
static const quadrotor_steady_regulator_state_t sizes = {{{1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f}}, {{1.0f,
     1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f}}, {{1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f}}, {{1.0f, 1.0f, 1.0f,
     1.0f, 1.0f, 1.0f, 1.0f}}, {0U}};

static const quadrotor_steady_regulator_params_t parameters[] = {
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f, 212.718f, 212.718f}},
    {{{1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f}}, {{0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, 212.718f}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f,
     1200000.0f, 1200000.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, 212.718f}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{1200000.0f,
     1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, 212.718f}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f, 1200000.0f,
     1200000.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f,
     212.718f, 212.718f}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {12000.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f, 212.718f, 212.718f}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f, 10000.0f, 212.718f}},
    {{{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}}, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
     0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 212.718f, 212.718f, 212.718f, -10000.0f}}
};

static const quadrotor_steady_regulator_step_in_t step_inputs[] = {
    {true, -0.0761191f, true, -0.109989f, true, 0.0502493f, true, -0.0396745f, -1.44157f, 0.407663f, 1.25497f,
     -0.489928f, 0.679434f, 2.02468f, 1.22211f, 1.59598f, 2.11715f, -1.39779f, -1.79346f, -0.71336f},
    {true, 0.0762029f, true, 0.0377565f, true, 0.00773396f, true, 0.0593584f, -2.32497f, 0.71992f, 1.10797f,
     0.22263f, 1.64199f, -0.735441f, 0.889477f, 0.0108338f, -0.11108f, -0.198963f, 2.10505f, 2.37806f},
    {true, -0.243482f, true, -0.112201f, true, 0.0213528f, true, -0.0226287f, -0.000494554f, -2.048f, -0.357495f,
     -1.001f, 0.0412232f, 2.32557f, -0.263568f, -1.40004f, 1.18371f, -0.619124f, -0.816571f, 1.68679f},
    {false, 0.0201846f, false, -0.0443159f, false, -0.0374405f, false, 0.139988f, -0.160108f, -1.03731f, 1.3006f,
     -0.811203f, 1.30427f, -0.958706f, 2.99175f, 0.843604f, 0.664307f, 0.0427412f, -2.19675f, -1.69794f},
    {true, 0.11927f, true, -0.0618027f, true, 0.032354f, true, 0.0920052f, 0.657647f, 0.840753f, -2.21124f,
     -1.00539f, 1.13306f, -2.96671f, -0.211721f, 0.0226372f, -1.00541f, -0.587783f, -1.83958f, 3.60268f},
    {true, 0.211061f, true, -0.0830172f, true, -0.177755f, true, -0.0749943f, 2.72902f, -0.668982f, 2.2147f,
     -0.0607729f, -0.0136228f, 2.51147f, -0.614854f, -0.710754f, -0.392744f, -0.964474f, 1.43153f, -0.242941f},
    {true, -0.0694914f, true, -0.0828615f, true, 0.0196889f, true, -0.0604561f, 0.414169f, 2.87941f, -1.26182f,
     1.05319f, -0.712456f, 0.874111f, 1.42234f, 0.730384f, -1.47222f, 2.91782f, -0.506339f, -0.0702889f},
    {false, 0.0513498f, false, -0.00673939f, false, -0.0309091f, false, 0.138504f, -0.329608f, -1.01441f,
     -1.14948f, -0.622291f, -1.98423f, -1.14418f, -0.329535f, 0.46735f, -0.690394f, 0.457489f, -2.73971f, 0.759823f},
    {true, -0.111711f, true, -0.0266316f, true, -0.097985f, true, 0.0089782f, -0.380534f, 2.08359f, 0.404166f,
     1.84687f, -0.0273631f, 0.653437f, -1.24717f, 1.42444f, -0.454221f, -1.45257f, -0.458088f, -2.57328f},
    {true, -0.0193319f, true, 0.00294076f, true, -0.101476f, true, -0.0612385f, 0.815144f, -0.632791f, 1.03308f,
     1.14728f, -0.903364f, -1.15292f, 0.587395f, -2.01832f, 0.731953f, -1.10617f, -2.24063f, 1.00265f},
    {true, 0.0361816f, true, -0.032421f, true, 0.185148f, true, 0.0245481f, 1.759f, 2.06948f, -1.51086f,
     -2.0874f, -0.0678886f, 1.59305f, 0.532567f, -0.53553f, -0.0692278f, 1.03389f, 0.858155f, 2.8233f},
    {false, -0.171115f, false, 0.17055f, false, 0.0744923f, false, -0.117177f, 2.20389f, -1.69347f, -1.06144f,
     0.734769f, 0.208238f, -0.654084f, -0.899651f, -0.589808f, 1.14861f, 0.453747f, 0.238628f, 2.06047f},
    {true, -0.0654583f, true, 0.0316654f, true, -0.00534722f, true, -0.0120106f, 0.0284148f, 0.196914f,
     -0.417069f, -0.644251f, -0.185529f, 2.0363f, 0.28416f, 1.97822f, -0.502785f, -0.536973f, 1.51846f, 1.21189f},
    {true, 0.0145683f, true, 0.117517f, true, 0.163463f, true, -0.0140864f, -0.0927672f, 0.456348f, 0.297442f,
     1.20345f, -1.89172f, 1.01334f, 0.913699f, 0.18679f, -0.132016f, 1.83574f, -1.68122f, -1.54015f},
    {true, 0.179796f, true, -0.0438062f, true, -0.0474574f, true, -0.0924497f, -2.3959f, -0.123069f, 0.372122f,
     -2.07527f, -0.548234f, 1.31071f, 0.28046f, 0.0485115f, -0.217696f, 1.33969f, 1.25055f, -1.32423f},
    {false, -0.0623861f, false, 0.0264863f, false, 0.115324f, false, -0.156106f, 0.258275f, -0.508873f,
     0.557604f, -0.526347f, -1.31022f, -1.0385f, -1.03766f, -1.08219f, 1.69667f, 1.08038f, 0.828409f, 2.78884f},
    {true, -0.127759f, true, -0.0358587f, true, -0.147687f, true, 0.146233f, 0.550618f, -0.249036f, -0.804126f,
     3.49138f, -0.6577f, -0.315124f, -0.661954f, -0.812407f, 0.0266629f, 1.49027f, 1.05992f, 0.576812f},
    {true, 0.0772142f, true, 0.0269404f, true, -0.132545f, true, 0.0406726f, 0.29328f, 0.300632f, -0.647614f,
     -1.17176f, 1.61707f, 2.19282f, 2.41545f, 0.665419f, 1.2994f, -0.325135f, 0.857923f, -1.66215f},
    {true, 0.060288f, true, 0.0913954f, true, -0.0242766f, true, 0.13352f, 1.14877f, -2.82667f, -2.6918f,
     1.76064f, -0.035204f, -2.48103f, -1.75034f, 1.79731f, -0.173469f, -0.271683f, 1.85182f, 1.91373f},
    {false, 0.0549426f, false, 0.105422f, false, -0.0866145f, false, 0.0427106f, 0.908649f, 1.94303f, -0.947167f,
     0.400419f, -2.81996f, 0.605538f, -1.49141f, -1.59248f, -1.09263f, -0.845998f, -1.13895f, 0.12673f},
    {true, 0.0258749f, true, -0.189946f, true, -0.106767f, true, -0.0442607f, -1.04437f, 2.65743f, 0.56833f,
     1.32959f, 0.329345f, -1.30525f, 0.605712f, 1.72796f, 1.57239f, 0.372986f, 0.643254f, -1.23547f},
    {true, 0.186157f, true, 0.0539132f, true, 0.0297007f, true, -0.0388207f, 2.05897f, -1.48466f, 1.44127f,
     0.627186f, -0.536632f, -1.71636f, -0.467927f, -2.28626f, 0.490049f, 1.72307f, 1.28633f, -1.09677f},
    {true, -0.140046f, true, 0.0251848f, true, 0.0405845f, true, 0.193716f, 2.44253f, -2.02134f, -0.31001f,
     1.0183f, -1.00196f, 1.29593f, 0.154579f, 0.390315f, 0.490785f, 1.4809f, 0.546429f, 0.912036f},
    {false, -0.0607451f, false, 0.0922119f, false, 0.0246988f, false, -0.0326842f, -0.212288f, -1.33455f,
     1.17762f, -0.298301f, -2.10014f, -0.119185f, -0.879717f, 0.376313f, 0.461242f, 0.790392f, -1.98919f, -0.707304f},
    {true, (float)NAN, true, -0.0647573f, true, 0.0414564f, true, 0.049401f, 2.14064f, -1.34746f, -2.26619f,
     -0.865243f, -1.12798f, -0.0303019f, -0.379643f, -0.00383055f, -1.05726f, -1.04192f, 1.47403f, 0.0913581f},
    {true, -0.0869234f, true, (float)NAN, true, 0.0255623f, true, -0.146426f, -1.50607f, -1.10766f, -0.96284f,
     0.587043f, 0.426686f, -2.01735f, -1.10706f, 0.228341f, -0.667539f, -0.49297f, -1.74559f, 0.981685f},
    {true, 0.150959f, true, 0.0926664f, true, (float)NAN, true, 0.0374854f, 0.109597f, 0.480372f, 0.273675f,
     0.842083f, 0.377072f, 0.463972f, -0.929735f, -0.040454f, 1.11816f, -1.41428f, 1.02993f, -0.764134f},
    {true, -0.0100389f, true, -0.0564344f, true, 0.154802f, true, (float)INFINITY, 0.761964f, 0.525662f,
     -2.59468f, -1.61053f, -1.23635f, 0.95021f, -0.0528774f, -0.816606f, -0.0161642f, -0.107795f, -0.150594f,
     0.178779f},
    {true, -0.0869234f, true, -0.131118f, true, 0.0255623f, true, -0.146426f, (float)NAN, -1.10766f, -0.96284f,
     0.587043f, 0.426686f, -2.01735f, -1.10706f, 0.228341f, -0.667539f, -0.49297f, -1.74559f, 0.981685f},
    {true, -0.30691f, true, 0.0438801f, true, 0.0738257f, true, 0.0850183f, 10000.0f, 1.60883f, -3.10554f,
     -0.618244f, -1.34286f, 0.798267f, -0.48164f, 0.836048f, 3.02009f, -1.49567f, 1.076f, -1.05212f},
    {true, -0.0100389f, true, -0.0564344f, true, 0.154802f, true, -0.0216382f, 0.761964f, 0.525662f, -2.59468f,
     -1.61053f, -1.23635f, 0.95021f, -0.0528774f, -0.816606f, -0.0161642f, -0.107795f, -0.150594f, 1000.0f},
    {true, -0.015134f, true, 0.0333673f, true, -0.074215f, true, 0.0378185f, -1.56025f, -2.34035f, -1.11545f,
     -2.77484f, -1.07537f, 0.375709f, -1.48545f, 0.636714f, -0.942763f, 0.0678831f, -0.451542f, 0.100801f}
};

static const quadrotor_steady_regulator_step_out_t step_outputs[] = {
    {{(quadrotor_steady_regulator_status_t)0, {-0.0761191f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.109989f}}, {(quadrotor_steady_regulator_status_t)0, {0.0502493f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0396745f}}, {292.788f, 164.811f, 111.244f, 175.335f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0785198f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0411044f}}, {(quadrotor_steady_regulator_status_t)0, {0.00620447f}},
     {(quadrotor_steady_regulator_status_t)0, {0.060566f}}, {188.841f, 275.977f, 169.004f, 218.592f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.24352f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.110053f}}, {(quadrotor_steady_regulator_status_t)0, {0.0196112f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0232462f}}, {181.016f, 173.555f, 164.767f, 223.653f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {347.211f, 267.802f, 143.175f, 111.249f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.126756f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0561892f}}, {(quadrotor_steady_regulator_status_t)0, {0.0299534f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0920869f}}, {200.001f, 302.103f, 228.852f, 234.524f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.214802f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0756089f}}, {(quadrotor_steady_regulator_status_t)0, {-0.181103f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0777143f}}, {138.025f, 167.906f, 220.317f, 208.939f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.0722336f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0730405f}}, {(quadrotor_steady_regulator_status_t)0, {0.0218027f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0608521f}}, {249.548f, 249.413f, 169.091f, 156.507f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {219.183f, 256.68f, 263.992f, 202.933f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.112308f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0142574f}}, {(quadrotor_steady_regulator_status_t)0, {-0.0964784f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0104508f}}, {182.896f, 147.293f, 283.589f, 207.19f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.0165213f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0159334f}}, {(quadrotor_steady_regulator_status_t)0, {-0.0970092f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0600615f}}, {236.584f, 208.377f, 226.056f, 250.367f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0395364f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0197205f}}, {(quadrotor_steady_regulator_status_t)0, {0.192636f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0275711f}}, {218.671f, 233.303f, 105.593f, 221.074f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {201.306f, 177.533f, 193.417f, 304.535f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.063226f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0453516f}}, {(quadrotor_steady_regulator_status_t)0, {-0.00358267f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.00974744f}}, {180.554f, 252.385f, 160.382f, 167.199f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.018757f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.130023f}}, {(quadrotor_steady_regulator_status_t)0, {0.165363f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0114927f}}, {262.638f, 194.404f, 205.598f, 179.163f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.183475f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0350769f}}, {(quadrotor_steady_regulator_status_t)0, {-0.0505628f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0894675f}}, {218.937f, 221.818f, 195.76f, 164.886f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {216.584f, 175.144f, 181.636f, 351.439f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.129642f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0257993f}}, {(quadrotor_steady_regulator_status_t)0, {-0.149327f}},
     {(quadrotor_steady_regulator_status_t)0, {0.152069f}}, {176.158f, 176.462f, 240.908f, 284.69f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0792456f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0379264f}}, {(quadrotor_steady_regulator_status_t)0, {-0.129665f}},
     {(quadrotor_steady_regulator_status_t)0, {0.041967f}}, {312.731f, 211.886f, 70.722f, 121.944f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0599356f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.101381f}}, {(quadrotor_steady_regulator_status_t)0, {-0.0174064f}},
     {(quadrotor_steady_regulator_status_t)0, {0.133555f}}, {154.317f, 251.078f, 271.947f, 288.106f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {152.659f, 184.093f, 295.284f, 246.19f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0236541f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.182815f}}, {(quadrotor_steady_regulator_status_t)0, {-0.0991502f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0483567f}}, {312.103f, 173.973f, 158.265f, 259.455f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.18318f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0667026f}}, {(quadrotor_steady_regulator_status_t)0, {0.0404495f}},
     {(quadrotor_steady_regulator_status_t)0, {-0.0415091f}}, {225.458f, 168.805f, 253.835f, 291.869f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.148647f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0361229f}}, {(quadrotor_steady_regulator_status_t)0, {0.0502631f}},
     {(quadrotor_steady_regulator_status_t)0, {0.192249f}}, {212.694f, 195.458f, 169.069f, 233.157f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {224.262f, 173.094f, 258.432f, 241.565f}},
    {{(quadrotor_steady_regulator_status_t)-1, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {-0.069116f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0333817f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0473793f}}, {178.162f, 267.783f, 243.183f, 186.134f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.0903878f}}, {(quadrotor_steady_regulator_status_t)-1, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0349711f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.150413f}}, {167.327f, 240.709f, 297.637f, 229.283f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.136024f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0989965f}}, {(quadrotor_steady_regulator_status_t)-1, {0.0f}}, {(quadrotor_steady_regulator_status_t)0,
     {0.0293935f}}, {201.261f, 143.467f, 215.415f, 262.43f}},
    {{(quadrotor_steady_regulator_status_t)0, {-0.00957775f}}, {(quadrotor_steady_regulator_status_t)0,
     {-0.0593346f}}, {(quadrotor_steady_regulator_status_t)0, {0.159057f}},
     {(quadrotor_steady_regulator_status_t)-1, {0.0f}}, {226.831f, 217.893f, 187.074f, 199.798f}},
    {{(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}},
     {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {(quadrotor_steady_regulator_status_t)0, {0.0f}}, {0.0f,
     0.0f, 0.0f, 0.0f}}
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
    quadrotor_steady_regulator_status_t status;
};

static const struct vector vectors[] = {
    { ENTRY_INIT, 0, 0, 0, 0, 0, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 0, 0, 0, 1, 0, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 1, 1, 0, 2, 1, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 2, 2, 0, 3, 2, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 3, 3, 0, 4, 3, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 4, 4, 0, 5, 4, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 5, 5, 0, 6, 5, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 6, 6, 0, 7, 6, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 7, 7, 0, 8, 7, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 8, 8, 0, 9, 8, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 9, 9, 0, 10, 9, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 10, 10, 0, 11, 10, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 11, 11, 0, 12, 11, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 12, 12, 0, 13, 12, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 13, 13, 0, 14, 13, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 14, 14, 0, 15, 14, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 15, 15, 0, 16, 15, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 16, 16, 0, 17, 16, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 17, 17, 0, 18, 17, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 18, 18, 0, 19, 18, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 19, 19, 0, 20, 19, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 20, 20, 0, 21, 20, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 21, 21, 0, 22, 21, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 22, 22, 0, 23, 22, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 23, 23, 0, 24, 23, QUADROTOR_STEADY_REGULATOR_OK },
    { ENTRY_STEP, 25, 24, 0, 26, 24, QUADROTOR_STEADY_REGULATOR_SKIPPED },
    { ENTRY_STEP, 27, 25, 0, 28, 25, QUADROTOR_STEADY_REGULATOR_SKIPPED },
    { ENTRY_STEP, 29, 26, 0, 30, 26, QUADROTOR_STEADY_REGULATOR_SKIPPED },
    { ENTRY_STEP, 31, 27, 0, 32, 27, QUADROTOR_STEADY_REGULATOR_SKIPPED },
    { ENTRY_STEP, 27, 28, 0, 27, 28, QUADROTOR_STEADY_REGULATOR_BAD_INPUT },
    { ENTRY_STEP, 33, 29, 0, 33, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 31, 30, 0, 31, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW },
    { ENTRY_INIT, 0, 0, 1, 0, 0, QUADROTOR_STEADY_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 2, 0, 0, QUADROTOR_STEADY_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 3, 0, 0, QUADROTOR_STEADY_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 4, 0, 0, QUADROTOR_STEADY_REGULATOR_BAD_PARAM },
    { ENTRY_INIT, 0, 0, 5, 0, 0, QUADROTOR_STEADY_REGULATOR_BAD_PARAM },
    { ENTRY_STEP, 34, 31, 0, 34, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 35, 31, 0, 35, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 36, 31, 0, 36, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 37, 31, 0, 37, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 0, 31, 6, 0, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW },
    { ENTRY_STEP, 0, 31, 7, 0, 28, QUADROTOR_STEADY_REGULATOR_OVERFLOW }
};

static int differs(float value, float expected, float size)
{
    const int both_nan = (value != value) && (expected != expected);

    return !both_nan && !(fabsf(value - expected) <= (0.002f * (fabsf(expected) + size)));
}

static int memory_differs(const quadrotor_steady_regulator_state_t *state,
     const quadrotor_steady_regulator_state_t *wanted)
{
    int count = 0;

    for (int i = 0; i < 7; i++)
    {
        count += differs(state->generator_x.w_reading[i], wanted->generator_x.w_reading[i],
     sizes.generator_x.w_reading[i]);
    }
    for (int i = 0; i < 7; i++)
    {
        count += differs(state->generator_y.w_reading[i], wanted->generator_y.w_reading[i],
     sizes.generator_y.w_reading[i]);
    }
    for (int i = 0; i < 7; i++)
    {
        count += differs(state->generator_z.w_reading[i], wanted->generator_z.w_reading[i],
     sizes.generator_z.w_reading[i]);
    }
    for (int i = 0; i < 7; i++)
    {
        count += differs(state->generator_yaw.w_reading[i], wanted->generator_yaw.w_reading[i],
     sizes.generator_yaw.w_reading[i]);
    }
    return count;
}

/* Every status has a sentence of its own, and so has a value that is none; the model has its hash. */
static int texts_are_wrong(void)
{
    static const quadrotor_steady_regulator_status_t known[] = {
        QUADROTOR_STEADY_REGULATOR_OK,
        QUADROTOR_STEADY_REGULATOR_GATED,
        QUADROTOR_STEADY_REGULATOR_CLAMPED,
        QUADROTOR_STEADY_REGULATOR_SKIPPED,
        QUADROTOR_STEADY_REGULATOR_RECOVERED,
        QUADROTOR_STEADY_REGULATOR_BAD_INPUT,
        QUADROTOR_STEADY_REGULATOR_BAD_PARAM,
        QUADROTOR_STEADY_REGULATOR_NOT_POSITIVE,
        QUADROTOR_STEADY_REGULATOR_OVERFLOW
    };
    const char *const unknown = quadrotor_steady_regulator_status_text((quadrotor_steady_regulator_status_t)127);
    int wrong = (strcmp(quadrotor_steady_regulator_model(), "16afd8e2") != 0);

    for (size_t i = 0; i < (sizeof(known) / sizeof(known[0])); i++)
    {
        wrong += (strcmp(quadrotor_steady_regulator_status_text(known[i]), unknown) == 0);
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
        quadrotor_steady_regulator_state_t state = memories[v->start];
        quadrotor_steady_regulator_status_t status = QUADROTOR_STEADY_REGULATOR_OK;
        int count = 0;

        switch (v->entry)
        {
            case ENTRY_INIT:
            {
                status = quadrotor_steady_regulator_init(&state, &parameters[v->parameters]);
                break;
            }
            case ENTRY_STEP:
            {
                quadrotor_steady_regulator_step_out_t answer = step_outputs[v->outputs];
                const quadrotor_steady_regulator_step_out_t *const expected =
                    &step_outputs[v->outputs];

                status = quadrotor_steady_regulator_step(&state, &parameters[v->parameters],
     &step_inputs[v->inputs], &answer);
                count += (answer.generator_x.status_update != expected->generator_x.status_update);
                count += differs(answer.generator_x.update.innovation, expected->generator_x.update.innovation, 1.0f);
                count += (answer.generator_y.status_update != expected->generator_y.status_update);
                count += differs(answer.generator_y.update.innovation, expected->generator_y.update.innovation, 1.0f);
                count += (answer.generator_z.status_update != expected->generator_z.status_update);
                count += differs(answer.generator_z.update.innovation, expected->generator_z.update.innovation, 1.0f);
                count += (answer.generator_yaw.status_update != expected->generator_yaw.status_update);
                count += differs(answer.generator_yaw.update.innovation,
     expected->generator_yaw.update.innovation, 1.0f);
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
