// SPDX-License-Identifier: MIT
// Asks a model of a flight that stood still in parts, header and block, for rows near those it was trained on.
#include <cstdio>
#include "pinnquad/pinnquad.hpp"
#include "still/model.hpp"
template <class Inverse>
int refusals(const Inverse& inverse) {
  int refused = pinnquad::self_test(inverse) == pinnquad::Status::ok ? 0 : 1;
  for (const auto& golden : TrainedQuadModel::golden_features) {
    for (const float moved : {0.0f, 0.03f, -0.03f}) {  // on the training rows, and near them
      TrainedQuadModel::Inputs in;
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        in.linear_acceleration_m_s2[i] = golden[k];
        in.angular_acceleration_rad_s2[i] = golden[3 + k];
        in.velocity_m_s[i] = golden[6 + k];
        in.body_rates_rad_s[i] = golden[9 + k];
      }
      in.angular_acceleration_rad_s2[2] += 10 * moved;
      in.velocity_m_s[2] += moved;
      in.body_rates_rad_s[2] += moved;
      in.attitude = pinnquad::from_euler(pinnquad::EulerAngles<float>{golden[12], golden[13], moved});
      pinnquad::Commands<float> u{};
      if (inverse.predict(in, u) != pinnquad::Status::ok) ++refused;
      for (const float v : u) refused += v > -1.0f && v < 2.0f ? 0 : 1;
    }
  }
  return refused;
}
int main() {
  alignas(pinnquad::model_block_alignment) static unsigned char bytes[100000];
  std::FILE* file = std::fopen("still/model.block", "rb");
  const std::size_t size = std::fread(bytes, 1, sizeof bytes, file);
  pinnquad::ModelView<TrainedQuadModel> view;
  if (pinnquad::ModelView<TrainedQuadModel>::open(bytes, size, view) != pinnquad::Status::ok) return 1;
  const pinnquad::InverseDynamics<pinnquad::ModelView<TrainedQuadModel>> of_block(view);
  const int refused = refusals(pinnquad::InverseDynamics<TrainedQuadModel>()) + refusals(of_block);
  std::printf("%d refused\n", refused);
  return refused == 0 ? 0 : 1;
}
