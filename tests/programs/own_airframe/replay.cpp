// SPDX-License-Identifier: MIT
// A model that was trained on an airframe from a file, flown with nothing of the trainer: its header brings the
// airframe.
//   replay <replay.txt> <model.block>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include "model.hpp"

namespace {

using namespace pinnquad;

using Model = TrainedQuadModel;
constexpr double agreement = 1e-6;  // float rounding of another order of summation, commands in 0..1

// what the file says, and the library's airframe of that shape does not
static_assert(Model::Vehicle::value<double>().mass_kg == 1.31);
static_assert(!std::is_same_v<Model::Vehicle, PaperQuadrotor>);
static_assert(Model::sample_period_s > 0.0);

/// Rows whose commands are the trainer's; -1 for a file that can't be read.
template <class Inverse>
int agreeing(const char* path, const Inverse& inverse) {
  std::ifstream file(path);
  std::string word;
  int version = 0, columns = 0, rows = 0, agreed = 0;
  if (!(file >> word >> version >> rows >> columns) || columns != 24) return -1;
  for (int row = 0; row < rows; ++row) {
    double v[24];
    for (double& value : v) {
      if (!(file >> value)) return -1;
    }
    Model::Inputs in;
    for (int i = 0; i < 3; ++i) {
      in.linear_acceleration_m_s2[i] = float(v[i]);
      in.angular_acceleration_rad_s2[i] = float(v[3 + i]);
      in.velocity_m_s[i] = float(v[6 + i]);
      in.body_rates_rad_s[i] = float(v[9 + i]);
    }
    in.attitude = {float(v[12]), float(v[13]), float(v[14]), float(v[15])};
    Commands<float> commands{};
    float x[Model::Features::size];
    Model::Features::extract(in, static_cast<float*>(x));
    inverse.evaluate(x, commands.data());  // no matter whether a test row lies in the envelope
    bool same = true;
    for (int i = 0; i < 4; ++i) same = same && std::abs(double(commands[std::size_t(i)]) - v[16 + i]) <= agreement;
    agreed += same;
  }
  std::printf("%d of %d rows agree\n", agreed, rows);
  return agreed == rows ? agreed : 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  const InverseDynamics<Model> inverse;
  if (self_test(inverse) != Status::ok) return std::puts("the self test failed"), 1;
  if (agreeing(arguments[1], inverse) <= 0) return 1;

  std::ifstream file(arguments[2], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  ModelView<Model> view;
  const Status opened = ModelView<Model>::open(bytes.data(), bytes.size(), view);  // operator new aligns to 16
  std::printf("block: %s\n", to_string(opened));
  if (opened != Status::ok) return 1;
  const InverseDynamics<ModelView<Model>> viewed(view);
  return self_test(viewed) == Status::ok && agreeing(arguments[1], viewed) > 0 ? 0 : 1;
}
