// SPDX-License-Identifier: MIT
// What is written into an exported header reads back bit for bit, and names what it was made of.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "data/temporary_folder.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/initialization.hpp"

namespace {

using namespace pinnquad;

using Net = Network<float, Inputs<16>, Dense<5>, Relu, Dense<4>>;
using Model = TrainedModel<Net, Context<PaperFeatures, PaperQuadrotor>>;

Model some_model(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  Model model;
  model.network = initialised<Net>(engine);
  for (std::size_t i = 0; i < 16; ++i) {
    model.input.mean[i] = float(standard_normal(engine));
    model.input.spread[i] = float(0.5 + uniform_01(engine));
    model.envelope_lower[i] = float(-5 - uniform_01(engine));
    model.envelope_upper[i] = float(5 + uniform_01(engine));
  }
  return model;
}

std::string written(const Model& model, const std::vector<Model::FeatureVector>& golden, const Provenance& from = {}) {
  std::ostringstream out;
  write_model(out, "SomeModel", model, golden, from);
  return out.str();
}

/// The numbers in the braces behind `name = `.
std::vector<float> numbers_of(const std::string& header, const std::string& name) {
  const std::size_t begin = header.find(" " + name + " = {");
  REQUIRE(begin != std::string::npos);
  const std::size_t end = header.find(';', begin);
  const std::string text = header.substr(begin + name.size() + 3, end - begin - name.size() - 3);
  std::vector<float> numbers;
  static const std::regex number(R"([-+]?[0-9.]+(e[-+]?[0-9]+)?f)");
  for (std::sregex_iterator i(text.begin(), text.end(), number), last; i != last; ++i) {
    numbers.push_back(std::strtof(i->str().c_str(), nullptr));
  }
  return numbers;
}

}  // namespace

TEST_CASE("a literal reads back as the same bits and has the type of its value") {
  std::mt19937_64 engine(1);
  std::vector<float> values = {0.0f,
                               -0.0f,
                               1.0f,
                               -1.0f,
                               100.0f,
                               1e30f,
                               3e-39f,
                               std::numeric_limits<float>::max(),
                               std::numeric_limits<float>::denorm_min()};
  for (int i = 0; i < 2000; ++i)
    values.push_back(float(standard_normal(engine) * std::pow(10.0, uniform(engine, -20, 20))));
  for (const float value : values) {
    const std::string text = detail::literal(value);
    CHECK(text.back() == 'f');
    CHECK(text.find_first_of(".e") != std::string::npos);  // `1f` is not C++
    const float back = std::strtof(text.c_str(), nullptr);
    CHECK(back == value);
    CHECK(std::signbit(back) == std::signbit(value));
  }
  CHECK(detail::literal(3.0) == "3.0");
  CHECK(detail::literal(0.1) == "0.1");
}

TEST_CASE("type names are those that another translation unit can write") {
  CHECK(type_name<float>() == "float");
  CHECK(type_name<PaperFeatures>() == "pinnquad::PaperFeatures");
  CHECK(type_name<Net>().find("pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<5>, pinnquad::Relu, "
                              "pinnquad::Dense<4>>") == 0);  // with every compiler
}

TEST_CASE("weights, scalers, envelope and golden vectors are in the header, bit for bit") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Model model = some_model(seed);
    const std::vector<Model::FeatureVector> golden(3, Model::FeatureVector{0.5f, 1.5f, -2.5f});
    const std::string header = written(model, golden);
    const std::vector<float> parameters = numbers_of(header, "parameters");
    REQUIRE(parameters.size() == static_cast<std::size_t>(Net::parameter_count));
    for (std::size_t i = 0; i < parameters.size(); ++i) CHECK(parameters[i] == model.network.parameters[i]);
    const std::vector<float> input = numbers_of(header, "input");
    REQUIRE(input.size() == 32);
    for (std::size_t i = 0; i < 16; ++i) {
      CHECK(input[i] == model.input.mean[i]);
      CHECK(input[16 + i] == model.input.spread[i]);
    }
    const std::vector<float> lower = numbers_of(header, "envelope_lower");
    const std::vector<float> upper = numbers_of(header, "envelope_upper");
    REQUIRE(lower.size() == 16);
    REQUIRE(upper.size() == 16);
    for (std::size_t i = 0; i < 16; ++i) {
      CHECK(lower[i] == model.envelope_lower[i]);
      CHECK(upper[i] == model.envelope_upper[i]);
    }
    const std::vector<float> commands = numbers_of(header, "golden_commands");
    REQUIRE(commands.size() == 12);
    const Commands<float> predicted = model.predict(golden[0]);
    for (std::size_t i = 0; i < 12; ++i) CHECK(commands[i] == predicted[i % 4]);
  }
}

TEST_CASE("provenance is told, and no text can break out of its string") {
  Provenance from;
  from.training_data = "flight \"one\"\\\n.csv";
  from.training_data_hash = 0xabcu;
  from.training_rows = 9000;
  from.seed = 42;
  from.epochs = 300;
  from.loss = "MSE";
  const std::string header = written(some_model(1), {Model::FeatureVector{}}, from);
  CHECK(header.find("training_data = \"flight \\\"one\\\"\\\\ .csv\";") != std::string::npos);
  CHECK(header.find("training_data_hash = 0x0000000000000abc;") != std::string::npos);
  CHECK(header.find("training_rows = 9000;") != std::string::npos);
  CHECK(header.find("seed = 42u;") != std::string::npos);
  CHECK(header.find("epochs = 300;") != std::string::npos);
  CHECK(header.find("#pragma once") != std::string::npos);
  CHECK(header.find("static_assert(pinnquad::require_model<SomeModel>());") != std::string::npos);
}

TEST_CASE("what the model was trained for is told as data") {
  const std::string header = written(some_model(1), {Model::FeatureVector{}});
  for (const char* line :
       {"int format_version = 2;", "frame = \"body FRD, world NED\";",
        "output_names = {{\"u1\", \"u2\", \"u3\", \"u4\"}};", "output_unit = \"1\";",
        "vehicle_name = \"paper_quadrotor\";", "\"sin_yaw\", \"cos_yaw\"}};", "\"rad\", \"1\", \"1\"}};",
        "motor_torque_signs = {{\n    {{-1, 1, 1}},\n    {{1, -1, 1}},\n    {{1, 1, -1}},\n    {{-1, -1, -1}}}};"}) {
    CAPTURE(line);
    CHECK(header.find(line) != std::string::npos);
  }
}

TEST_CASE("a struct needs a name and a model golden vectors; a refused export leaves no file") {
  CHECK(is_identifier("MyQuadModel"));
  CHECK(is_identifier("_x9"));
  CHECK_FALSE(is_identifier(""));
  CHECK_FALSE(is_identifier("9lives"));
  CHECK_FALSE(is_identifier("my-model"));
  CHECK_FALSE(is_identifier("a b"));
  std::ostringstream out;
  CHECK_THROWS_AS(write_model(out, "my model", some_model(1), {Model::FeatureVector{}}, {}), std::invalid_argument);
  CHECK_THROWS_AS(write_model(out, "Model", some_model(1), {}, {}), std::invalid_argument);
  CHECK_THROWS_WITH(write_model(out, "Model", some_model(1), {Model::FeatureVector{7.0f}}, {}),
                    "export: golden vector 1 lies outside the envelope");
  CHECK(out.str().empty());
  const pinnquad_test::TemporaryFolder folder;
  CHECK_THROWS_AS(write_model_header(folder.path("model.hpp"), "Model", some_model(1), {}, {}), std::invalid_argument);
  CHECK(folder.listing().empty());
  write_model_header(folder.path("model.hpp"), "Model", some_model(1), {Model::FeatureVector{}}, {});
  CHECK(folder.listing().size() == 1);
}
