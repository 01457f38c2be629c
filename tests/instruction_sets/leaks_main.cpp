// SPDX-License-Identifier: MIT
// Calls the baseline's copy of leaks.cpp.
extern "C" void predict_baseline(const float* x, float* y);

int main() {
  const float x[16] = {};
  float y[1] = {1.0f};
  predict_baseline(x, y);
  return static_cast<int>(y[0]);
}
