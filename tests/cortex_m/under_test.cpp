// SPDX-License-Identifier: MIT
// An exported model as firmware uses it. MODEL_HEADER and MODEL name it: what write_model.cpp wrote.
#include "under_test.hpp"

#include MODEL_HEADER
#include "pinnquad/inference/self_test.hpp"

namespace {

MODEL::Inputs inputs_from(const float* raw) noexcept {
  MODEL::Inputs inputs;
  for (int i = 0; i < 3; ++i) {
    inputs.linear_acceleration_m_s2[i] = raw[i];
    inputs.angular_acceleration_rad_s2[i] = raw[3 + i];
    inputs.velocity_m_s[i] = raw[6 + i];
    inputs.body_rates_rad_s[i] = raw[9 + i];
  }
  inputs.attitude = {raw[12], raw[13], raw[14], raw[15]};
  return inputs;
}

/// Of an answer that is no network nothing is said.
template <class Answer, class = void>
struct WorkspaceOf {
  static constexpr unsigned bytes = 0;
};
template <class Answer>
struct WorkspaceOf<Answer, std::void_t<decltype(Answer::workspace_bytes)>> {
  static constexpr unsigned bytes = Answer::workspace_bytes;
};

}  // namespace

void pinnquad_forward(const float* x, float* y) { MODEL::Network::forward(MODEL::parameters.data(), x, y); }

unsigned pinnquad_workspace_bytes() { return WorkspaceOf<MODEL::Network>::bytes; }

unsigned char pinnquad_predict(const float* raw, float* commands) {
  pinnquad::Commands<float> result{};
  const pinnquad::Status status = pinnquad::InverseDynamics<MODEL>{}.predict(inputs_from(raw), result);
  if (status == pinnquad::Status::ok) {
    for (std::size_t i = 0; i < result.size(); ++i) commands[i] = result[i];
  }
  return static_cast<unsigned char>(status);
}

void pinnquad_features(const float* raw, float* x) { MODEL::Features::extract<float>(inputs_from(raw), x); }

bool pinnquad_wants_gentle_states() {
#ifdef TRAINED_ON_A_FLIGHT
  return true;
#else
  return false;
#endif
}

unsigned char pinnquad_self_test() {
  return static_cast<unsigned char>(pinnquad::self_test(pinnquad::InverseDynamics<MODEL>{}));
}
