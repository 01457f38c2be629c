// SPDX-License-Identifier: MIT
// An exported header reads back bit for bit, and names its sources.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/training/initialization.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace pinnquad;

using Net = Network<float, InputSize<16>, Dense<5>, Relu, Dense<4>>;
using Model = TrainedModel<Net, Context<PaperFeatures, PaperQuadrotor>>;

Model some_model() {
  std::mt19937_64 engine(1);
  Model model;
  model.network = initialised<Net>(engine);
  for (std::size_t i = 0; i < 16; ++i) {
    model.input.mean[i] = float(standard_normal(engine));
    model.input.standard_deviation[i] = float(0.5 + uniform_01(engine));
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
  CHECK(type_name<Network<float, InputSize<3>, Dense<2>, pinnquad::Gelu, pinnquad::Silu, pinnquad::Softplus,
                          pinnquad::Sine, pinnquad::Elu, pinnquad::LeakyRelu>>() ==
        "pinnquad::Network<float, pinnquad::InputSize<3>, pinnquad::Dense<2>, pinnquad::Gelu, pinnquad::Silu, "
        "pinnquad::Softplus, pinnquad::Sine, pinnquad::Elu, pinnquad::LeakyRelu>");
  CHECK(type_name<Net>().find("pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<5>, pinnquad::Relu, "
                              "pinnquad::Dense<4>>") == 0);  // with every compiler
  // nor of its flags: a type of an inline namespace that names an instruction set, in another such
  using Small = Network<float, InputSize<2>, Dense<1>>;
  CHECK(type_name<pinnquad::Sum<pinnquad::Saturated<Small>, Small>>() ==
        "pinnquad::Sum<pinnquad::Saturated<pinnquad::Network<float, pinnquad::InputSize<2>, pinnquad::Dense<1>>>, "
        "pinnquad::Network<float, pinnquad::InputSize<2>, pinnquad::Dense<1>>>");
}

TEST_CASE("provenance is told, and no text can break out of its string") {
  Provenance from;
  from.training_data = "flight \"one\"\\\n.csv";
  from.training_data_hash = 0xabcu;
  from.training_rows = 9000;
  from.seed = 42;
  from.epochs = 300;
  from.loss = "MSE";
  const std::string header = written(some_model(), {Model::FeatureVector{}}, from);
  CHECK(header.find("training_data = \"flight \\\"one\\\"\\\\?.csv\";") != std::string::npos);
  CHECK(header.find("training_data_hash = 0x0000000000000abc;") != std::string::npos);
  CHECK(header.find("training_rows = 9000;") != std::string::npos);
  CHECK(header.find("seed = 42u;") != std::string::npos);
  CHECK(header.find("epochs = 300;") != std::string::npos);
  CHECK(header.find("#pragma once") != std::string::npos);
  CHECK(header.find("static_assert(pinnquad::require_model<SomeModel>());") != std::string::npos);
}

TEST_CASE("what the model was trained for is told as data") {
  const std::string header = written(some_model(), {Model::FeatureVector{}});
  for (const char* line : {"int format_version = 5;", "// Features: vdot_bx [m/s^2], ", " cos_yaw [1].\n",
                           "// Outputs: u1 [1], u2 [1], u3 [1], u4 [1].\n", "using Features = pinnquad::PaperFeatures;",
                           "using Vehicle = pinnquad::PaperQuadrotor;", "allocation = {{\n    {{", "shape_hash = 0x"}) {
    CAPTURE(line);
    CHECK(header.find(line) != std::string::npos);
  }
}

TEST_CASE("a struct needs a name and a model golden vectors; a refused export leaves no file") {
  std::ostringstream out;
  CHECK_THROWS_AS(write_model(out, "my model", some_model(), {Model::FeatureVector{}}, {}), std::invalid_argument);
  CHECK_THROWS_AS(write_model(out, "class", some_model(), {Model::FeatureVector{}}, {}), std::invalid_argument);
  CHECK_THROWS_AS(write_model(out, "Model", some_model(), {}, {}), std::invalid_argument);
  CHECK_THROWS_WITH(write_model(out, "Model", some_model(), {Model::FeatureVector{7.0f}}, {}),
                    "export: golden vector 1 lies outside the envelope");
  CHECK(out.str().empty());
  const pinnquad_test::TemporaryFolder folder;
  CHECK_THROWS_AS(write_model_header(folder.path("model.hpp"), "Model", some_model(), {}, {}), std::invalid_argument);
  CHECK(folder.listing().empty());
  write_model_header(folder.path("model.hpp"), "Model", some_model(), {Model::FeatureVector{}}, {});
  CHECK(folder.listing().size() == 1);
}

TEST_CASE("a number that is not finite is not written: it has no literal") {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const auto said = [](const Model& model) -> std::string {
    std::ostringstream out;
    std::string message;
    try {
      write_model(out, "Model", model, {Model::FeatureVector{}}, {});
    } catch (const std::invalid_argument& error) {
      message = error.what();
    }
    CHECK(out.str().empty() == !message.empty());
    CHECK_THROWS_AS(model_block(model, {Model::FeatureVector{}}, {}), std::invalid_argument);
    return message;
  };
  const Model sound = some_model();
  Model model = sound;
  model.envelope_upper[2] = infinity;
  CHECK(said(model) == "export: number 3 of the upper envelope is not finite");
  model = sound;
  model.envelope_lower[0] = -infinity;
  CHECK(said(model) == "export: number 1 of the lower envelope is not finite");
  model = sound;
  model.input.standard_deviation[15] = infinity;
  CHECK(said(model) == "export: number 16 of the input standard deviations is not finite");
  model = sound;
  model.output.mean[1] = nan;
  CHECK(said(model) == "export: number 2 of the output means is not finite");
  model = sound;
  model.network.parameters[7] = nan;
  CHECK(said(model) == "export: number 8 of the parameters is not finite");
  model = sound;
  model.input.mean = {};  // the first layer gives its biases: whatever the order of its sums, none is below 0
  for (float& weight : model.network.parameters) weight = std::numeric_limits<float>::max();
  CHECK(said(model) == "export: number 1 of the commands of golden vector 1 is not finite");
}

namespace {

/// Groups digits, as the locales of many countries do.
struct GroupedDigits : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

}  // namespace

TEST_CASE("no locale plays a part, whether it is the stream's or the program's") {
  Provenance from;
  from.training_rows = 1234567;
  from.seed = 7654321;
  from.epochs = 300000;
  from.verdict = Verdict{0.875, -1234.5, 0.5};
  const std::vector<Model::FeatureVector> golden(3, Model::FeatureVector{0.5f, 1.5f, -2.5f});
  const std::string plain = written(some_model(), golden, from);
  CHECK(plain.find("training_rows = 1234567;") != std::string::npos);
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new GroupedDigits));
  const std::string grouped = written(some_model(), golden, from);  // its stream has the global locale
  const std::vector<unsigned char> block = model_block(some_model(), golden, from);
  std::locale::global(before);
  CHECK(grouped == plain);
  CHECK(block == model_block(some_model(), golden, from));
}

TEST_CASE("a model tells how it was judged, and at its head if it is not for flight") {
  Provenance from;
  CHECK(written(some_model(), {Model::FeatureVector{}}, from).find("worse_than_mean") == std::string::npos);
  from.verdict = Verdict{0.75, 0.5, 0.25};
  std::string header = written(some_model(), {Model::FeatureVector{}}, from);
  for (const char* line : {"double test_r_squared = 0.75;", "double linear_regression_r_squared = 0.5;",
                           "bool worse_than_mean = false;", "bool beats_linear_regression = true;"}) {
    CHECK(header.find(line) != std::string::npos);
  }
  CHECK(header.find("NOT FOR FLIGHT") == std::string::npos);
  from.verdict = Verdict{-0.25, 0.5, -0.75};
  header = written(some_model(), {Model::FeatureVector{}}, from);
  CHECK(header.find("worse than the mean of the commands.\n") < header.find("#pragma once"));
  CHECK(header.find("bool worse_than_mean = true;") != std::string::npos);
  CHECK(header.find("bool beats_linear_regression = false;") != std::string::npos);
  from.verdict = Verdict{0.12345678901, -1e300, 0};
  header = written(some_model(), {Model::FeatureVector{}}, from);
  CHECK(header.find("double test_r_squared = 0.123457;") != std::string::npos);
  CHECK(header.find("double linear_regression_r_squared = -1e+300;") != std::string::npos);
  from.verdict = Verdict{std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity(), 0};
  header = written(some_model(), {Model::FeatureVector{}}, from);
  CHECK(header.find("r_squared") == std::string::npos);  // no literal for that
  CHECK(header.find("bool worse_than_mean = true;") != std::string::npos);
}

TEST_CASE("the opening comment has the verdict in words: figures, what is proven, how well slopes are known") {
  Provenance from;
  const auto comment = [&from] {
    const std::string header = written(some_model(), {Model::FeatureVector{}}, from);
    return header.substr(0, header.find("#pragma once"));
  };
  const auto has = [&](const std::string& words) { return comment().find(words) != std::string::npos; };
  CHECK_FALSE(has("PROVEN"));
  CHECK_FALSE(has("R^2"));
  from.verdict = Verdict{0.75, 0.5, 0.25};
  from.verdict->answered_share = 0.9346;
  CHECK(has("// On rows that it was not trained on: R^2 0.750, worst motor 0.250, linear regression 0.500.\n"));
  CHECK(has("// Of those rows its guard let it answer 93.5 %.\n"));
  from.verdict->linear_regression_r_squared = std::numeric_limits<double>::quiet_NaN();
  CHECK(has("R^2 0.750, worst motor 0.250.\n"));
  from.verdict->test_r_squared = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(has("R^2"));
  const Airframe<double> airframe = some_model().airframe<double>();
  const AxisSlopes own = hover_slopes(airframe);
  from.proven_slopes = {0.98 * own[0], 1.02 * own[1], 0.5 * own[2]};
  CHECK(has("// PROVEN: each signed sum"));
  CHECK(has("Slopes over the airframe's own in hover: roll 0.98, pitch 1.02, yaw 0.50.\n"));
  from.signs_unproven = true;
  CHECK(has("// NOT PROVEN: "));
  CHECK_FALSE(has("// PROVEN"));
  from.slopes[0] = {true, 0, 0, 0.9 * hover_thrust_slope(airframe), 1.1 * hover_thrust_slope(airframe)};
  from.slopes[2] = {true, 0, 0, 0.97 * own[1], 1.04 * own[1], 0.4, 0.25 * own[1]};
  CHECK(
      has("// Their 95 % intervals by the training rows: pitch 0.97 to 1.04 (by smoothed rows; least squares 0.25), "
          "thrust 0.90 to 1.10.\n"));
  from.airframe_known = false;  // then they are slopes
  from.signs_unproven = false;
  from.proven_slopes = {0.01234, 0.5, 1};
  from.slopes[2] = {true, 0, 0, 0.0321, 0.0456};
  CHECK(has("Slopes in s^2/rad: roll 0.0123, pitch 0.5000, yaw 1.0000.\n"));
  CHECK(has("// AIRFRAME ASSUMED: "));
  CHECK(has("rows: pitch 0.0321 to 0.0456, thrust "));
}

TEST_CASE("time constants of a bias are one constant more, and nothing else; with proven slopes the comment says so") {
  const Model model = some_model();
  Provenance from;
  const std::string without = written(model, {Model::FeatureVector{}}, from);
  CHECK(without.find("of the bias") == std::string::npos);
  from.bias_time_constants_s = {0.2, 0.5, 0, 1};
  std::string with = written(model, {Model::FeatureVector{}}, from);
  CHECK(numbers_of(with, "bias_time_constants_s") == std::vector<float>{0.2f, 0.5f, 0.0f, 1.0f});
  const std::size_t begin = with.find("  // of the bias"), end = with.find(";\n", with.find("bias_time_constants_s"));
  REQUIRE(end != std::string::npos);
  with.erase(begin, end + 2 - begin);
  CHECK(with == without);

  from.proven_slopes = AxisSlopes{0.01, 0.01, 0.3};
  const std::string proven = written(model, {Model::FeatureVector{}}, from);
  CHECK(proven.find("// each command widens by 0.7000 at most.\n") != std::string::npos);
  CHECK(proven.find("they hold as they are, for it is of the past") < proven.find("#pragma once"));
  from.bias_time_constants_s = {0.2, 0.5, 61, 1};
  CHECK_THROWS_AS(written(model, {Model::FeatureVector{}}, from), std::invalid_argument);
}

TEST_CASE("names from outside stay inside their quotes, whatever they hold") {
  Provenance from;
  for (const auto& [name, literal] :
       std::vector<std::pair<std::string, std::string>>{{"a*/ int x; /*", "a*/ int x; /*"},
                                                        {"a\\\nint x;", "a\\\\?int x;"},
                                                        {"a\"; int x; //", "a\\\"; int x; //"},
                                                        {"a?"
                                                         "?/\";?"
                                                         "?'",
                                                         "a?\\?/\\\";?\\?'"},
                                                        {"???", "?\\?\\?"},
                                                        {"\xff\xfe", "?\\?"},
                                                        {"M\xc3\xbcnchen", "M\xc3\xbcnchen"},
                                                        {"\xe2\x80\xae};", "?};"},
                                                        {"a\r\n#error", "a?\\?#error"}}) {
    from.training_data = name;
    from.loss = name;
    const std::string header = written(some_model(), {Model::FeatureVector{}}, from);
    CAPTURE(from.training_data);
    CHECK(header.find(" training_data = \"" + literal + "\";\n") != std::string::npos);
    CHECK(header.find(" loss = \"" + literal + "\";\n") != std::string::npos);
    CHECK(header.find("??") == std::string::npos);  // no trigraph
  }
}
