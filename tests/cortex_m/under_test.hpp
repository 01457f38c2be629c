// SPDX-License-Identifier: MIT
// The code measured, behind C functions in a file of its own: compiled as firmware compiles it, called from
// measure_*.cpp.
#pragma once

extern "C" {

/// The bare network on standardised inputs: y[0, 4) = network(x[0, 16)).
void pinnquad_forward(const float* x, float* y);

/// Network::workspace_bytes.
unsigned pinnquad_workspace_bytes();

/// predict() on raw inputs: linear and angular acceleration, velocity, body rates, attitude (w, x, y, z), 16 numbers.
/// Returns the Status; `commands` are untouched unless there is an output.
unsigned char pinnquad_predict(const float* raw, float* commands);

/// The model's feature vector from the same raw inputs.
void pinnquad_features(const float* raw, float* x);

/// True where the model's envelope is that of a flight: states have to be gentle.
bool pinnquad_wants_gentle_states();

/// Replays the model's golden vectors; returns the Status.
unsigned char pinnquad_self_test();

}  // extern "C"
