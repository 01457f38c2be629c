// Inverse-dynamics model, exported by pinnquad 0.2.0. Generated: export again rather than edit.
// SI units, rad. Commands in the order of the airframe's rotors.
#pragma once

#ifndef PINNQUAD_ONE_FILE
#include "pinnquad/flight.hpp"
#endif

struct StructuredQuadModelAirframe {
  static constexpr const char* name = "paper_quadrotor";

  template <class Scalar>
  static constexpr pinnquad::Airframe<Scalar> value() {
    pinnquad::Airframe<Scalar> a{};
    a.mass_kg = Scalar(1.5);
    a.inertia_kg_m2 = {Scalar(0.01469), Scalar(0.01686), Scalar(0.03093)};
    a.rotors[0] = {Scalar(0.243952), Scalar(0.243952), pinnquad::Spin::counter_clockwise};
    a.rotors[1] = {Scalar(-0.243952), Scalar(-0.243952), pinnquad::Spin::counter_clockwise};
    a.rotors[2] = {Scalar(0.243952), Scalar(-0.243952), pinnquad::Spin::clockwise};
    a.rotors[3] = {Scalar(-0.243952), Scalar(0.243952), pinnquad::Spin::clockwise};
    a.thrust_coefficient = Scalar(0.1099);
    a.power_coefficient = Scalar(0.04016);
    a.propeller_diameter_m = Scalar(0.2286);
    a.max_rotor_speed_rev_s = Scalar(141.66666666666666);
    a.rotor_time_constant_s = Scalar(0.005);
    a.drag_area_m2 = {Scalar(0.00538309), Scalar(0.00583809), Scalar(0.1099301)};
    a.drag_deadband_m_s = Scalar(0.1);
    return a;
  }
};

// Features: s_z [m/s^2], wdot_x [rad/s^2], wdot_y [rad/s^2], wdot_z [rad/s^2], w_x [rad/s], w_y [rad/s], w_z [rad/s],
// w_yz [rad^2/s^2], w_zx [rad^2/s^2], w_xy [rad^2/s^2], down_x [1], down_y [1], down_z [1], v_bx [m/s], v_by [m/s],
// v_bz [m/s], vv_bx [m^2/s^2], vv_by [m^2/s^2], vv_bz [m^2/s^2].
// Outputs: sum [1], roll_sum [1], pitch_sum [1], yaw_sum [1].
struct StructuredQuadModel {
  using Scalar = float;
  using Network = pinnquad::AxisAligned<float, 19, 1>;
  using Features = pinnquad::InverseFeatures;
  using Outputs = pinnquad::AxisCommandOutputs;
  using Vehicle = StructuredQuadModelAirframe;
  using Inputs = Features::Inputs<Scalar>;

  static constexpr int format_version = 5;
  static constexpr const char* name = "StructuredQuadModel";

  // provenance
  static constexpr const char* training_data = "flight.csv";
  static constexpr std::uint64_t training_data_hash = 0xffc75d13f065d38b;
  static constexpr int training_rows = 9000;
  static constexpr std::uint64_t seed = 1u;
  static constexpr int epochs = 300;
  static constexpr const char* loss = "least squares, slopes above 0; MSE of the residual, which sees no angular acceleration";

  // how it was judged, on rows that it was not trained on: R^2, mean over the commands
  static constexpr double test_r_squared = 0.997576;
  static constexpr double linear_regression_r_squared = 0.501877;
  static constexpr bool worse_than_mean = false;
  static constexpr bool beats_linear_regression = true;

  // commands and clock of its training (exported/model_facts.hpp)
  static constexpr auto command_meaning = pinnquad::CommandMeaning::thrust;
  static constexpr double command_lower = 0.0;
  static constexpr double command_upper = 1.0;
  static constexpr double sample_period_s = 0.05;
  static constexpr double lag_removed_s = 0.0;
  // thrust [N], roll, pitch and yaw torque [N m] of each rotor at full command, rated density
  static constexpr std::array<std::array<double, 4>, 4> allocation = {{
    {{7.378601163836665, 7.378601163836665, 7.378601163836665, 7.378601163836665}},
    {{-1.8000245111202822, 1.8000245111202822, 1.8000245111202822, -1.8000245111202822}},
    {{1.8000245111202822, -1.8000245111202822, 1.8000245111202822, -1.8000245111202822}},
    {{0.09809941226552932, 0.09809941226552932, -0.09809941226552932, -0.09809941226552932}}}};

  // standardisation: (value - mean) / spread
  static constexpr pinnquad::Scaler<float, 19> input = {{{
      -10.60104f, 0.020964937f, -0.007618452f, 0.0027962378f, 0.0017799996f, -0.010040494f, -0.023070259f, 0.00071977166f,
      0.0015268595f, -0.029746199f, -0.0060639717f, -0.0022914642f, 0.91750336f, -0.06563983f, 0.072327495f, -0.0325947f,
      -0.20055203f, 0.43830353f, -0.07728899f}}, {{
      3.2481582f, 6.6925383f, 6.422259f, 0.7804613f, 0.76041776f, 0.75472367f, 0.49838737f, 0.38451332f,
      0.37424567f, 1.0546119f, 0.27604085f, 0.2642437f, 0.110101365f, 2.6742134f, 2.709066f, 3.4190755f,
      12.597322f, 13.231606f, 17.587645f}}};
  static constexpr pinnquad::Scaler<float, 4> output = {{{2.1890504f, 0.00011220662f, -0.00023531374f, 0.000593688f}}, {{0.74393225f, 0.056849185f, 0.062605895f, 0.24830383f}}};

  // training envelope per feature, margin included
  static constexpr std::array<float, 19> envelope_lower = {{
      -18.369385f, -62.93935f, -69.53046f, -2.9990337f, -4.9589367f, -4.654145f, -1.3799664f, -4.0596356f,
      -4.063651f, -10.427972f, -0.9238285f, -0.9327756f, 0.5809749f, -8.807265f, -8.849543f, -9.032713f,
      -64.639946f, -65.26378f, -67.99176f}};
  static constexpr std::array<float, 19> envelope_upper = {{
      -1.9364641f, 69.54528f, 60.255764f, 3.0002792f, 4.7170267f, 4.8948994f, 1.379915f, 4.155187f,
      3.693751f, 10.152393f, 0.9247344f, 0.92948246f, 1.0380927f, 8.79258f, 8.710594f, 8.989354f,
      64.42457f, 63.230473f, 67.34058f}};

  // golden vectors: features in physical units -> commands
  static constexpr std::array<std::array<float, 19>, 8> golden_features = {{
    {{
        -10.137386f, 1.6412008f, 2.3428137f, -0.7416976f, -0.026490957f, 0.031666182f, -0.014576939f, -0.000461596f,
        0.00038615704f, -0.00083886745f, 4.9363675e-06f, -0.0022116546f, 0.99999756f, 5.1590865e-05f, -0.000428918f, -0.0076584904f,
        2.6616174e-09f, -1.8397064e-07f, -5.8652477e-05f}},
    {{
        -9.356004f, -4.451444f, 3.9031389f, 0.00222197f, 0.30793744f, -0.40468976f, 0.42749932f, -0.1730046f,
        0.13164304f, -0.12461913f, -0.12662534f, -0.10948108f, 0.9858904f, -3.353405f, -0.68246436f, -2.3345625f,
        -11.245325f, -0.4657576f, -5.4501824f}},
    {{
        -13.5918865f, 0.6581574f, -0.4645158f, 0.2914994f, 0.7241958f, -0.59479094f, -0.6969938f, 0.41456562f,
        -0.50475997f, -0.4307451f, 0.28437862f, 0.26903164f, 0.92019063f, -4.224259f, -4.70407f, -3.4875534f,
        -17.844364f, -22.128275f, -12.163029f}},
    {{
        -10.345643f, 2.5746205f, 0.26563144f, 0.2314362f, 0.5027847f, -0.16478461f, -0.66855645f, 0.11016782f,
        -0.33613998f, -0.08285119f, -0.15879555f, -0.111913785f, 0.98094815f, -2.9899395f, -6.162629f, -0.15947127f,
        -8.939738f, -37.977997f, -0.025431087f}},
    {{
        -14.310015f, -4.2966447f, 1.4313574f, 1.3183945f, 0.071127035f, -0.1952287f, -0.24052364f, 0.046957117f,
        -0.017107733f, -0.013886038f, -0.112107135f, -0.06175796f, 0.99177516f, -6.3774805f, -1.5430406f, 2.115184f,
        -40.672256f, -2.3809743f, 4.474004f}},
    {{
        -9.030691f, 4.592774f, -1.7028439f, -0.5264084f, 0.18025339f, 0.34429684f, 0.76884586f, 0.2647112f,
        0.13858707f, 0.062060673f, 0.060045544f, -0.08346407f, 0.9947001f, 7.319401f, 0.2625456f, 0.65018326f,
        53.573627f, 0.06893019f, 0.42273828f}},
    {{
        -16.979437f, -4.890072f, 5.9408817f, 1.2183596f, 0.10979961f, -0.52373564f, 0.15768525f, -0.08258539f,
        0.017313778f, -0.05750597f, -0.0055649187f, 0.008832797f, 0.9999455f, 4.191687f, 2.8488612f, 1.6037447f,
        17.57024f, 8.116011f, 2.5719972f}},
    {{
        -11.333874f, -2.161003f, -0.56513834f, 0.549688f, 0.4291432f, -1.1452509f, 0.56410027f, -0.6460363f,
        0.2420798f, -0.49147663f, -0.30451536f, -0.059212964f, 0.9506652f, -4.2976336f, 0.3565637f, -4.5331345f,
        -18.469654f, 0.12713766f, -20.549309f}}}};
  static constexpr std::array<std::array<float, 4>, 8> golden_commands = {{
    {{0.46556062f, 0.46122307f, 0.59137815f, 0.5734624f}},
    {{0.5251953f, 0.4875961f, 0.5071569f, 0.50844187f}},
    {{0.77559066f, 0.7792845f, 0.7373719f, 0.732898f}},
    {{0.5481745f, 0.5567585f, 0.52187407f, 0.5080241f}},
    {{0.8363564f, 0.8125464f, 0.60707104f, 0.6182878f}},
    {{0.40770006f, 0.4354937f, 0.5117259f, 0.50036716f}},
    {{0.98765147f, 0.9361737f, 0.77151847f, 0.7631701f}},
    {{0.7230306f, 0.71379966f, 0.6292859f, 0.6441671f}}}};

  // layer by layer: weights row-major (row = output, column = input), then biases
  static constexpr std::array<float, 71> parameters = {{
      0.9807119f, 0.9847828f, 1.0113163f, -0.9020724f, 0.00045648072f, 0.0004874651f, -0.00021103122f, 8.8317414e-05f,
      6.384629e-05f, -0.00019099574f, -0.00021380035f, -0.00014991057f, -0.00040648703f, -0.00016288724f, -0.0012651205f, 0.0027408397f,
      -8.986771e-06f, 0.0014038426f, -0.43061453f, 9.925058e-05f, -0.039009273f, 0.00046733033f, 0.0022646226f, 0.052138958f,
      0.00063659623f, -7.8517434e-05f, 0.00029425032f, 0.0008626552f, -0.0030305437f, 0.00012633922f, -0.01906593f, -0.0053150197f,
      -0.0022521596f, 0.0035663026f, 0.004899349f, -0.0016414892f, 0.0016581971f, -0.037868846f, -0.0011161194f, -0.0007230229f,
      -0.055330876f, 0.0005564993f, -0.0007131018f, 0.00026116733f, 0.0009313348f, 0.011812149f, -0.0051881466f, 0.0024807812f,
      0.0020740896f, 0.004203783f, -0.0010791753f, 0.0034593819f, -0.0002972936f, -0.00065686525f, -0.006434239f, -0.00086983934f,
      -0.00025123588f, 0.10264491f, -0.0015613193f, 0.0022342945f, 0.0006267158f, -0.002746572f, 0.0005076283f, -0.0007971216f,
      0.002819453f, 1.5425916e-05f, 0.0039976374f, 9.024931e-15f, -5.67402e-17f, -1.1402832e-18f, -4.709057e-18f}};

  // over what the types say: layers, names and units, frame, airframe's name, motor order
  static constexpr std::uint64_t shape_hash = 0xef870c086a8774be;
  // over all of this: what was edited does not compile (exported/contents_hash.hpp)
  static constexpr std::uint64_t contents_hash = 0xb4279cd1ca8227e8;
};

static_assert(pinnquad::require_model<StructuredQuadModel>());
static_assert(pinnquad::require_certificate<StructuredQuadModel>());  // docs/certificate.md
