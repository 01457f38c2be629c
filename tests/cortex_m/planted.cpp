// SPDX-License-Identifier: MIT
// Forward passes that break rules: gate_rejects.sh must see the gate refuse each, by name. PLANTED says which: several
// are joined by |.
#include <cstdlib>

#include "under_test.hpp"

#include MODEL_HEADER

#define HEAP 0x1
#define DOUBLE_PRECISION 0x2
#define OPERATOR_NEW 0x4
#define RUN_TIME_INITIALISED 0x8
#define STATIC_BUFFER 0x10
#define DEEP_STACK 0x20
#define DATA_DEPENDENT 0x40
#define OTHER_ORDER 0x80
#define PLAIN_LOOPS 0x100
#define CODE_TWICE 0x200
#define WEIGHTS_IN_RAM 0x400

namespace {

using Net = MODEL::Network;

#if (PLANTED) & RUN_TIME_INITIALISED
float read_at_start() {
  const volatile float value = 1.0F;
  return value;
}
const float initialised_at_run_time = read_at_start();
#endif
#if (PLANTED) & STATIC_BUFFER
volatile float buffer[4];
#endif
#if (PLANTED) & WEIGHTS_IN_RAM
auto weights = MODEL::parameters;
#endif

#if (PLANTED) & (DATA_DEPENDENT | OTHER_ORDER | PLAIN_LOOPS)
/// Row by row in plain loops; skips zero inputs, or takes the inputs from the last to the first.
void dense(const float*& parameters, int inputs, int outputs, bool activated, const float* x, float* y) {
  for (int row = 0; row < outputs; ++row) {
    float sum = parameters[inputs * outputs + row];
    for (int i = 0; i < inputs; ++i) {
      const int column = (PLANTED) == OTHER_ORDER ? inputs - 1 - i : i;
#if (PLANTED) & DATA_DEPENDENT
      if (x[column] == 0.0F) continue;
      __asm__ volatile("");  // or the compiler makes a conditional instruction of it, whose count depends on nothing
#endif
      sum = pinnquad::multiply_add(parameters[row * inputs + column], x[column], sum);
    }
    y[row] = activated && sum < 0.0F ? 0.0F : sum;
  }
  parameters += (inputs + 1) * outputs;
}
#endif

}  // namespace

void pinnquad_forward(const float* x, float* y) {
#if (PLANTED) & (DATA_DEPENDENT | OTHER_ORDER | PLAIN_LOOPS)
  const float* parameters = MODEL::parameters.data();
  float hidden[2][25];
  dense(parameters, 16, 25, true, x, hidden[0]);
  for (int layer = 1; layer < 10; ++layer) {
    dense(parameters, 25, 25, true, hidden[(layer - 1) % 2], hidden[layer % 2]);
  }
  dense(parameters, 25, 4, false, hidden[1], y);
#else
  const float* parameters = MODEL::parameters.data();
#if (PLANTED) & WEIGHTS_IN_RAM
  parameters = weights.data();
#endif
#if (PLANTED) & DEEP_STACK
  volatile float scratch[50];
  for (int i = 0; i < 50; ++i) scratch[i] = x[i % 16];
#endif
  Net::forward(parameters, x, y);
#if (PLANTED) & DEEP_STACK
  if (scratch[7] > 1e37F) y[0] = scratch[8];
#endif
#if (PLANTED) & HEAP
  void* volatile raw = std::malloc(16);
  std::free(raw);
#endif
#if (PLANTED) & DOUBLE_PRECISION
  y[0] = static_cast<float>(static_cast<double>(y[0]) * 1.000000001);
#endif
#if (PLANTED) & OPERATOR_NEW
  float* volatile block = new float(y[0]);
  delete block;
#endif
#if (PLANTED) & RUN_TIME_INITIALISED
  y[0] += initialised_at_run_time - initialised_at_run_time;
#endif
#if (PLANTED) & STATIC_BUFFER
  buffer[0] = y[0];
#endif
#if (PLANTED) & CODE_TWICE
  using Wider = pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<24>, pinnquad::Dense<23>>;
  float unused[23];
  if (x[0] > 1e37F && y[0] < -1e37F) {
    Wider::forward(parameters, x, unused);
    y[0] = unused[22];
  }
#endif
#endif
}

unsigned pinnquad_workspace_bytes() { return Net::workspace_bytes; }
