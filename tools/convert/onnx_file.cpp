// SPDX-License-Identifier: MIT
#include "convert/onnx_file.hpp"

#include <onnx/onnx_pb.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "convert/stored_number.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/version.hpp"

namespace programs {
namespace {

using pinnquad::InputError;
using pinnquad::printable;

constexpr std::size_t widest = 1 << 14;
constexpr std::size_t most_numbers = std::size_t{1} << 24;
const std::map<int, StoredNumber> number_types = {{onnx::TensorProto::FLOAT, StoredNumber::float32},
                                                  {onnx::TensorProto::DOUBLE, StoredNumber::float64},
                                                  {onnx::TensorProto::FLOAT16, StoredNumber::float16},
                                                  {onnx::TensorProto::BFLOAT16, StoredNumber::bfloat16}};
constexpr const char* type_words = "FLOAT, DOUBLE, FLOAT16 or BFLOAT16";

/// Numbers of the file that depend on no input.
struct Constant {
  std::vector<std::size_t> shape;
  Numbers values;
};

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text = "[";
  for (std::size_t i = 0; i < shape.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  return text + "]";
}

/// A step of a chain and those before it, which others may go on from too.
struct Link {
  std::shared_ptr<const Link> before;
  ForeignStep step;
};

/// The place of a value behind its chain's last number b, within an activation that ONNX makes of several nodes:
/// c b, c erf(a b) + d or c sigmoid(a b) + d; or b > a, by which an exporter cuts a softplus short.
enum class Inner { plain, erf, sigmoid, above };

/// A tensor that depends on the input.
struct Value {
  std::size_t width = 0, slot = 0;
  std::shared_ptr<const Link> chain;
  Inner inner = Inner::plain;
  double inner_scale = 1;  ///< a
  Numbers scale, shift;    ///< c, d; of a plain value d is 0
};

/// Works out a node: a number of the last slot by those before.
using Operation = std::function<Numbers(const std::vector<Numbers>&)>;

class Graph {
 public:
  Graph(const std::string& bytes, const std::string& path, const FileBeside& beside) : path_(path), beside_(beside) {
    if (bytes.size() > std::size_t(std::numeric_limits<int>::max()) ||
        !model_.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())) || !model_.has_graph()) {
      refuse("an ONNX model", "none, or one that is cut short");
    }
  }

  ForeignNetwork network() {
    require_opset();
    for (const auto& tensor : model_.graph().initializer()) stored_[tensor.name()] = &tensor;
    const std::size_t inputs = take_input();
    constexpr int most_nodes = 1000;
    if (model_.graph().node_size() > most_nodes) {
      refuse("at most " + std::to_string(most_nodes) + " nodes", std::to_string(model_.graph().node_size()));
    }
    int number = 0;
    for (const auto& node : model_.graph().node()) {
      name_ = "node " + (node.name().empty() ? std::to_string(number) : "'" + printable(node.name()) + "'") + " (" +
              printable(node.op_type()) + ")";
      take_node(node);
      ++number;
    }
    const Value last = take_output();
    ForeignNetwork network;
    network.inputs = inputs;
    network.outputs = last.width;
    for (const Link* link = last.chain.get(); link; link = link->before.get()) network.steps.push_back(link->step);
    std::reverse(network.steps.begin(), network.steps.end());
    network.evaluate = [operations = std::move(operations_), slot = last.slot](const Numbers& x) {
      std::vector<Numbers> slots = {x};
      for (const Operation& operation : operations) slots.push_back(operation(slots));
      return slots[slot];
    };
    return network;
  }

 private:
  using Node = onnx::NodeProto;

  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw InputError(path_, 0, 0, expected, found);
  }
  [[noreturn]] void refuse_node(const std::string& expected, const std::string& found) const {
    refuse(name_ + ": " + expected, found);
  }

  void require_opset() const {
    constexpr std::int64_t oldest = 7;
    for (const auto& opset : model_.opset_import()) {
      if ((opset.domain().empty() || opset.domain() == "ai.onnx") && opset.version() < oldest) {
        refuse("operators of ONNX 7 or later", "version " + std::to_string(opset.version()));
      }
    }
  }

  static std::string type_text(int type) {
    return onnx::TensorProto::DataType_IsValid(type)
               ? onnx::TensorProto::DataType_Name(static_cast<onnx::TensorProto::DataType>(type))
               : std::to_string(type);
  }
  static bool is_number_type(int type) { return number_types.count(type) > 0; }

  std::size_t take_input() {
    const onnx::ValueInfoProto* input = nullptr;
    int count = 0;
    for (const auto& one : model_.graph().input()) {
      if (stored_.count(one.name())) continue;  // an initializer, as models of IR 3 list them
      input = &one;
      ++count;
    }
    if (count != 1) refuse("a graph with one input", std::to_string(count));
    const std::string what = "input '" + printable(input->name()) + "': ";
    const auto& type = input->type();
    if (!type.has_tensor_type() || !is_number_type(type.tensor_type().elem_type())) {
      refuse(what + "a tensor of " + type_words,
             type.has_tensor_type() ? type_text(type.tensor_type().elem_type()) : "another");
    }
    const auto& shape = type.tensor_type().shape();
    if (!type.tensor_type().has_shape() || shape.dim_size() != 2) {
      refuse(what + "a shape [rows, features]",
             type.tensor_type().has_shape() ? std::to_string(shape.dim_size()) + " dimensions" : "none");
    }
    const auto& features = shape.dim(1);
    if (!features.has_dim_value()) {
      refuse(what + "a number of features", features.dim_param().empty()
                                                ? "a dynamic one"
                                                : "a dynamic one, '" + printable(features.dim_param()) + "'");
    }
    if (features.dim_value() < 1 || features.dim_value() > std::int64_t(widest)) {
      refuse(what + "1 to " + std::to_string(widest) + " features", std::to_string(features.dim_value()));
    }
    const auto width = static_cast<std::size_t>(features.dim_value());
    values_[input->name()] = plain(width, 0, nullptr);
    return width;
  }

  Value take_output() {
    const auto& outputs = model_.graph().output();
    if (outputs.size() != 1) refuse("a graph with one output", std::to_string(outputs.size()));
    const std::string& output = outputs[0].name();
    name_ = "output '" + printable(output) + "'";
    if (!values_.count(output)) refuse_node("a number that depends on the input", "none");
    Value& value = made_plain(output);
    const auto& shape = outputs[0].type().tensor_type().shape();
    if (outputs[0].type().tensor_type().has_shape() && shape.dim_size() > 0) {
      const auto& last = shape.dim(shape.dim_size() - 1);
      if (last.has_dim_value() && last.dim_value() != std::int64_t(value.width)) {
        refuse_node(std::to_string(value.width) + " numbers, as its nodes make", std::to_string(last.dim_value()));
      }
    }
    return value;
  }

  static Value plain(std::size_t width, std::size_t slot, std::shared_ptr<const Link> chain) {
    Value value;
    value.width = width;
    value.slot = slot;
    value.chain = std::move(chain);
    value.scale.assign(width, 1);
    value.shift.assign(width, 0);
    return value;
  }
  static std::shared_ptr<const Link> behind(const Value& value, ForeignStep step) {
    return std::make_shared<const Link>(Link{value.chain, std::move(step)});
  }
  static bool is_uniform(const Numbers& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [&](double v) { return same(v, numbers.front()); });
  }
  static bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); }

  /// The value as the last number of its chain.
  Value& made_plain(const std::string& name) {
    Value& value = values_.at(name);
    if (value.inner == Inner::erf) refuse_node("Erf as GELU has it, v (1 + erf(v / sqrt 2)) / 2", "another use of it");
    if (value.inner == Inner::above) refuse_node("Greater before Where, as a softplus has it", "another use of it");
    if (value.inner == Inner::sigmoid) {
      if (!same(value.inner_scale, 1)) scale_chain(value, value.inner_scale);
      value.chain = behind(value, activation_step(ForeignActivation::sigmoid));
    }
    const bool is_one = is_uniform(value.scale) && same(value.scale.front(), 1);
    const bool is_zero =
        std::all_of(value.shift.begin(), value.shift.end(), [](double v) { return !(std::abs(v) > 0); });
    if (!is_one || !is_zero) value.chain = behind(value, affine_step(value.scale, value.shift));
    value = plain(value.width, value.slot, value.chain);
    return value;
  }
  static void scale_chain(Value& value, double by) {
    value.chain = behind(value, affine_step(Numbers(value.width, by), Numbers(value.width, 0)));
  }

  const onnx::AttributeProto* attribute(const Node& node, const char* name) const {
    for (const auto& one : node.attribute()) {
      if (one.name() == name) return &one;
    }
    return nullptr;
  }
  double number(const Node& node, const char* name, double otherwise) const {
    const auto* found = attribute(node, name);
    if (!found) return otherwise;
    if (!std::isfinite(found->f())) refuse_node(std::string("a number `") + name + "`", "NaN or Inf");
    return static_cast<double>(found->f());
  }
  std::int64_t whole(const Node& node, const char* name, std::int64_t otherwise) const {
    const auto* found = attribute(node, name);
    return found ? found->i() : otherwise;
  }

  /// The numbers of a tensor of the file, by name. Throws for a type that is none of a network's numbers, dims that do
  /// not fit its data, and NaN.
  Constant constant(const std::string& name) {
    const auto made = made_.find(name);
    if (made != made_.end()) return made->second;
    const auto found = stored_.find(name);
    if (found == stored_.end()) refuse_node("inputs that the graph makes before", "'" + printable(name) + "'");
    return constant(*found->second, "tensor '" + printable(name) + "'");
  }
  Constant constant(const onnx::TensorProto& tensor, const std::string& what) {
    const auto known = number_types.find(tensor.data_type());
    if (known == number_types.end()) refuse(what + ": numbers of " + type_words, type_text(tensor.data_type()));
    const StoredNumber type = known->second;
    const std::size_t each = bytes_of(type);
    Constant result;
    std::uint64_t count = 1;
    for (const std::int64_t size : tensor.dims()) {
      if (size < 0 || size > (1 << 28)) refuse(what + ": dims from 0 to 2^28", std::to_string(size));
      result.shape.push_back(static_cast<std::size_t>(size));
      count *= static_cast<std::uint64_t>(size);
      if (count > (1u << 28)) refuse(what + ": at most 2^28 numbers", "more");
    }
    const bool is_elsewhere = tensor.data_location() == onnx::TensorProto::EXTERNAL || tensor.external_data_size() > 0;
    const bool is_raw = is_elsewhere || tensor.has_raw_data();
    const std::string_view raw = is_elsewhere ? bytes_beside(tensor, what) : std::string_view(tensor.raw_data());
    const int listed = type == StoredNumber::float32   ? tensor.float_data_size()
                       : type == StoredNumber::float64 ? tensor.double_data_size()
                                                       : tensor.int32_data_size();
    if (is_raw ? raw.size() != count * each : static_cast<std::uint64_t>(listed) != count) {
      refuse(what + ": " + std::to_string(count) + " numbers for its shape " + shape_text(result.shape),
             is_raw ? std::to_string(raw.size()) + " bytes" : std::to_string(listed));
    }
    for (std::size_t i = 0; i < count; ++i) {
      const int place = static_cast<int>(i);
      const double value = is_raw                          ? number_at(raw.data() + each * i, type)
                           : type == StoredNumber::float32 ? static_cast<double>(tensor.float_data(place))
                           : type == StoredNumber::float64
                               ? tensor.double_data(place)
                               : number_of(static_cast<std::uint32_t>(tensor.int32_data(place)), type);
      if (!std::isfinite(value)) refuse(what + ": finite numbers", std::isnan(value) ? "NaN" : "Inf");
      result.values.push_back(value);
    }
    return result;
  }
  /// The bytes of a tensor that lie in a file beside the model.
  std::string_view bytes_beside(const onnx::TensorProto& tensor, const std::string& what) {
    std::map<std::string, std::string> said;
    for (const auto& entry : tensor.external_data()) {
      if (!said.emplace(entry.key(), entry.value()).second) {
        refuse(what + ": each key of its external data once", "'" + printable(entry.key()) + "' twice");
      }
    }
    const auto whole = [&](const char* key) -> std::optional<std::uint64_t> {
      const auto found = said.find(key);
      if (found == said.end()) return std::nullopt;
      const char *begin = found->second.data(), *end = begin + found->second.size();
      std::uint64_t value = 0;
      const auto read = std::from_chars(begin, end, value);
      if (read.ec != std::errc() || read.ptr != end) {
        refuse(what + ": a whole number `" + key + "` of its external data", "'" + printable(found->second) + "'");
      }
      return value;
    };
    const std::uint64_t offset = whole("offset").value_or(0);
    const std::optional<std::uint64_t> length = whole("length");
    const std::string& location = said["location"];
    if (!files_.count(location)) {
      constexpr std::size_t most_bytes = std::size_t{1} << 26;
      std::string& bytes = files_[location] = beside_(location, what);
      bytes_ += bytes.size();
      if (bytes_ > most_bytes) refuse("at most 64 MiB of external data", std::to_string(bytes_) + " bytes");
    }
    const std::string& file = files_[location];
    if (offset > file.size() || length.value_or(0) > file.size() - offset) {
      refuse(what + ": its data within the " + std::to_string(file.size()) + " bytes of " + printable(location),
             "offset " + std::to_string(offset) + (length ? ", length " + std::to_string(*length) : ""));
    }
    return std::string_view(file).substr(static_cast<std::size_t>(offset),
                                         static_cast<std::size_t>(length.value_or(file.size() - offset)));
  }
  /// Whole numbers of a tensor in the model's file, as a Reshape has them; of any other tensor none.
  std::vector<std::int64_t> whole_numbers(const std::string& name) const {
    const auto found = stored_.find(name);
    if (found == stored_.end() || found->second->data_type() != onnx::TensorProto::INT64) return {};
    const std::string& raw = found->second->raw_data();
    std::vector<std::int64_t> numbers(found->second->int64_data().begin(), found->second->int64_data().end());
    for (std::size_t at = 0; at + 8 <= raw.size(); at += 8) {
      std::int64_t number = 0;
      std::memcpy(&number, raw.data() + at, 8);  // little-endian, as the machines of this program
      numbers.push_back(number);
    }
    return numbers;
  }
  /// A constant that a node makes.
  void keep(const Node& node, Constant made) {
    count_numbers(made.values.size());
    made_[node.output(0)] = std::move(made);
  }
  /// One number for each of `width`, from one that is broadcast.
  Numbers channels(const std::string& name, std::size_t width) {
    const Constant c = constant(name);
    bool fits = c.values.size() == 1 || (c.values.size() == width && !c.shape.empty() && c.shape.back() == width);
    fits = fits && c.shape.size() <= 2;
    if (!fits) {
      refuse_node("a shape [" + std::to_string(width) + "] of '" + printable(name) + "'", shape_text(c.shape));
    }
    return c.values.size() == width ? c.values : Numbers(width, c.values.front());
  }

  const std::string& input(const Node& node, int place) const {
    static const std::string none;
    return place < node.input_size() ? node.input(place) : none;
  }
  bool depends(const std::string& name) const { return values_.count(name) > 0; }

  void require_inputs(const Node& node, int least, int most) const {
    if (node.input_size() < least || node.input_size() > most || node.output_size() < 1) {
      refuse_node(std::to_string(least) + " inputs and an output", std::to_string(node.input_size()));
    }
  }
  const Value& runtime_input(const Node& node, int place) {
    const std::string& name = input(node, place);
    if (!depends(name)) {
      refuse_node("input " + std::to_string(place + 1) + " that depends on the graph's input",
                  "'" + printable(name) + "'");
    }
    return values_.at(name);
  }

  void count_numbers(std::size_t more) {
    numbers_ += more;
    if (numbers_ > most_numbers) refuse_node("at most 2^24 numbers in all", "more");
  }
  /// Adds what a node makes: how it is worked out, and what it is of the chain.
  void put(const Node& node, Value value, Operation operation) {
    count_numbers(value.width + (value.chain ? value.chain->step.dense.weights.size() : 0));
    operations_.push_back(std::move(operation));
    value.slot = operations_.size();
    if (depends(node.output(0)) || stored_.count(node.output(0)) || made_.count(node.output(0))) {
      refuse_node("an output of its own", "'" + printable(node.output(0)) + "' again");
    }
    values_[node.output(0)] = std::move(value);
  }
  template <class Function>
  void put_elementwise(const Node& node, const Value& of, Value value, const Function& function) {
    put(node, std::move(value), [slot = of.slot, function](const std::vector<Numbers>& slots) {
      Numbers y = slots[slot];
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = function(y[i], i);
      return y;
    });
  }

  void take_node(const Node& node) {
    const std::string& op = node.op_type();
    const bool is_onnx = node.domain().empty() || node.domain() == "ai.onnx";
    if (is_onnx && op == "Constant") return take_constant(node);
    if (is_onnx && op == "Gemm") return take_gemm(node);
    if (is_onnx && op == "MatMul") return take_matmul(node);
    if (is_onnx && (op == "Add" || op == "Sub")) return take_sum(node, op == "Sub");
    if (is_onnx && (op == "Mul" || op == "Div")) return take_product(node, op == "Div");
    if (is_onnx && op == "BatchNormalization") return take_batch_norm(node);
    if (is_onnx && op == "Transpose") return take_transpose(node);
    if (is_onnx && (op == "Erf" || op == "Sigmoid")) return take_inner(node, op == "Erf" ? Inner::erf : Inner::sigmoid);
    if (is_onnx && op == "Clip") return take_clip(node);
    if (is_onnx && op == "Greater") return take_greater(node);
    if (is_onnx && op == "Where") return take_where(node);
    if (is_onnx && op == "Reshape") return take_reshape(node);
    if (is_onnx && (op == "Identity" || op == "Flatten" || op == "Dropout" || op == "Cast")) return take_identity(node);
    static const std::map<std::string, ForeignActivation> activations = {
        {"Relu", ForeignActivation::relu},           {"Tanh", ForeignActivation::tanh},
        {"Softplus", ForeignActivation::softplus},   {"Sin", ForeignActivation::sine},
        {"Gelu", ForeignActivation::gelu},           {"Elu", ForeignActivation::elu},
        {"LeakyRelu", ForeignActivation::leaky_relu}};
    const auto found = activations.find(op);
    if (!is_onnx || found == activations.end()) {
      refuse(
          "operators Gemm, MatMul, Add, Sub, Mul, Div, BatchNormalization, Relu, LeakyRelu, Elu, Clip, Tanh, Sigmoid, "
          "Gelu, Softplus, Sin, Erf, Identity, Flatten, Reshape, Dropout or Constant",
          name_ + (is_onnx ? "" : " of " + printable(node.domain())));
    }
    require_inputs(node, 1, 1);
    if (const auto* approximate = attribute(node, "approximate"); approximate && approximate->s() != "none") {
      refuse_node("approximate \"none\"", "\"" + printable(approximate->s()) + "\"");
    }
    ForeignStep step = activation_step(found->second);
    step.alpha = number(node, "alpha", step.alpha);
    put_activation(node, step);
  }
  void put_activation(const Node& node, const ForeignStep& step) {
    const std::size_t width = runtime_input(node, 0).width;
    if (step.has_own_alpha()) count_numbers(6 * width * width);  // of layers that make it (folded_network.hpp)
    const Value of = made_plain(input(node, 0));
    put_elementwise(node, of, plain(width, 0, behind(of, step)),
                    [step](double v, std::size_t) { return activated(step, v); });
  }
  /// Bounds are attributes before opset 11, inputs since; an exporter says none by the largest float.
  void take_clip(const Node& node) {
    require_inputs(node, 1, 3);
    const auto bound = [&](int place, const char* name, double none) {
      if (depends(input(node, place))) refuse_node("constant bounds", "one that depends on the input");
      const double said =
          input(node, place).empty() ? number(node, name, none) : channels(input(node, place), 1).front();
      return std::abs(said) < static_cast<double>(std::numeric_limits<float>::max()) ? said : none;
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const ForeignStep step = clip_step(bound(1, "min", -infinity), bound(2, "max", infinity));
    if (!(step.lower < step.upper)) refuse_node("a lower bound below the upper one", "another");
    put_activation(node, step);
  }
  /// b > a and the choice by it, as PyTorch's exporter writes softplus: where b > 20, b, else softplus(b).
  void take_greater(const Node& node) {
    require_inputs(node, 2, 2);
    runtime_input(node, 0);
    const Value of = made_plain(input(node, 0));
    const Numbers bounds = channels(input(node, 1), of.width);
    Value value = plain(of.width, 0, of.chain);
    value.inner = Inner::above;
    value.inner_scale = *std::min_element(bounds.begin(), bounds.end());
    put_elementwise(node, of, std::move(value),
                    [bounds](double v, std::size_t i) { return v > bounds[i] ? 1.0 : 0.0; });
  }
  void take_where(const Node& node) {
    require_inputs(node, 3, 3);
    constexpr double least = 16;  // where softplus(b) - b < 1.2e-7
    const Value gate = runtime_input(node, 0), line = runtime_input(node, 1), curve = runtime_input(node, 2);
    const auto untouched = [](const Value& value) {
      return is_uniform(value.scale) && same(value.scale.front(), 1) &&
             std::none_of(value.shift.begin(), value.shift.end(), [](double v) { return std::abs(v) > 0; });
    };
    const bool is_softplus = gate.inner == Inner::above && gate.inner_scale >= least && line.inner == Inner::plain &&
                             curve.inner == Inner::plain && untouched(gate) && untouched(line) && untouched(curve) &&
                             gate.chain == line.chain && curve.chain && curve.chain->before == line.chain &&
                             curve.chain->step.dense.outputs() == 0 && curve.chain->step.scale.empty() &&
                             curve.chain->step.activation == ForeignActivation::softplus;
    if (!is_softplus) refuse_node("Where as a softplus has it, b > 20 ? b : softplus(b)", "another use of it");
    put(node, curve, [a = gate.slot, b = line.slot, c = curve.slot](const std::vector<Numbers>& all) {
      Numbers y = all[c];
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = all[a][i] > 0 ? all[b][i] : y[i];
      return y;
    });
  }
  /// To [rows, features], as it is.
  void take_reshape(const Node& node) {
    require_inputs(node, 2, 2);
    const Value of = runtime_input(node, 0);
    const std::vector<std::int64_t> shape = whole_numbers(input(node, 1));
    const bool stays = shape.size() == 2 && shape[0] >= -1 && shape[0] <= 1 &&
                       (shape[1] == 0 || shape[1] == std::int64_t(of.width) || (shape[1] == -1 && shape[0] != -1));
    if (!stays) refuse_node("the shape [rows, " + std::to_string(of.width) + "], which it has", "another");
    put_elementwise(node, of, of, [](double v, std::size_t) { return v; });
  }

  void take_constant(const Node& node) {
    require_inputs(node, 0, 0);
    const auto* value = attribute(node, "value");
    if (value && value->has_t()) {
      stored_[node.output(0)] = &value->t();
      return;
    }
    const auto *one = attribute(node, "value_float"), *list = attribute(node, "value_floats");
    if (!one && !list) return;  // of another type: refused where it is used
    Constant made;
    if (one) {
      made.values = {static_cast<double>(one->f())};
    } else {
      for (const float v : list->floats()) made.values.push_back(static_cast<double>(v));
      made.shape = {made.values.size()};
    }
    for (const double v : made.values) {
      if (!std::isfinite(v)) refuse_node("finite numbers", "NaN or Inf");
    }
    keep(node, std::move(made));
  }

  void take_transpose(const Node& node) {
    require_inputs(node, 1, 1);
    if (depends(input(node, 0))) refuse_node("the transpose of a constant", "one of what depends on the input");
    const Constant from = constant(input(node, 0));
    if (from.shape.size() != 2) refuse_node("a matrix", shape_text(from.shape));
    Constant to{{from.shape[1], from.shape[0]}, Numbers(from.values.size())};
    for (std::size_t row = 0; row < from.shape[0]; ++row) {
      for (std::size_t column = 0; column < from.shape[1]; ++column) {
        to.values[column * from.shape[0] + row] = from.values[row * from.shape[1] + column];
      }
    }
    keep(node, std::move(to));
  }

  void take_identity(const Node& node) {
    require_inputs(node, 1, 3);
    if (node.op_type() == "Flatten" && whole(node, "axis", 1) != 1 && whole(node, "axis", 1) != -1) {
      refuse_node("axis 1", std::to_string(whole(node, "axis", 1)));
    }
    if (node.op_type() == "Cast" && !is_number_type(static_cast<int>(whole(node, "to", 0)))) {
      refuse_node(std::string("a Cast to ") + type_words, type_text(static_cast<int>(whole(node, "to", 0))));
    }
    if (node.op_type() == "Dropout" && !input(node, 2).empty()) {
      const auto mode = stored_.find(input(node, 2));
      const bool trains = mode == stored_.end() || mode->second->data_type() != onnx::TensorProto::BOOL ||
                          mode->second->raw_data().find('\1') != std::string::npos ||
                          std::any_of(mode->second->int32_data().begin(), mode->second->int32_data().end(),
                                      [](int v) { return v != 0; });
      if (trains) refuse_node("a network that no longer trains", "a training_mode");
    }
    if (!depends(input(node, 0))) {
      keep(node, constant(input(node, 0)));
      return;
    }
    const Value of = runtime_input(node, 0);
    put_elementwise(node, of, of, [](double v, std::size_t) { return v; });
  }

  /// y = x W^T + b, W row by row (row = output).
  void put_dense(const Node& node, ForeignDense dense) {
    const Value of = made_plain(input(node, 0));
    if (dense.outputs() == 0 || dense.outputs() > widest) {
      refuse_node("1 to " + std::to_string(widest) + " outputs", std::to_string(dense.outputs()));
    }
    const std::size_t outputs = dense.outputs();
    Value value = plain(outputs, 0, behind(of, dense_step(dense)));
    put(node, std::move(value), [dense = std::move(dense), slot = of.slot](const std::vector<Numbers>& slots) {
      const Numbers& x = slots[slot];
      Numbers y = dense.bias;
      for (std::size_t row = 0; row < y.size(); ++row) {
        double sum = 0;
        for (std::size_t k = 0; k < x.size(); ++k) sum += dense.weights[row * x.size() + k] * x[k];
        y[row] += sum;
      }
      return y;
    });
  }
  /// `is_transposed`: the file's matrix has a row per output.
  ForeignDense weights_of(const Node& node, bool is_transposed) {
    const std::size_t inputs = runtime_input(node, 0).width;
    if (depends(input(node, 1))) refuse_node("a constant matrix", "one that depends on the input");
    const Constant matrix = constant(input(node, 1));
    const std::size_t along = is_transposed ? 1 : 0;
    if (matrix.shape.size() != 2 || matrix.shape[along] != inputs) {
      refuse_node("a matrix of " + std::to_string(inputs) + (is_transposed ? " columns" : " rows") + " in '" +
                      printable(input(node, 1)) + "'",
                  "shape " + shape_text(matrix.shape));
    }
    const std::size_t outputs = matrix.shape[1 - along];
    ForeignDense dense{inputs, matrix.values, Numbers(outputs, 0)};
    for (std::size_t row = 0; !is_transposed && row < outputs; ++row) {
      for (std::size_t k = 0; k < inputs; ++k) dense.weights[row * inputs + k] = matrix.values[k * outputs + row];
    }
    return dense;
  }
  void take_gemm(const Node& node) {
    require_inputs(node, 2, 3);
    if (whole(node, "transA", 0) != 0) refuse_node("transA 0", "another");
    ForeignDense dense = weights_of(node, whole(node, "transB", 0) != 0);
    const double alpha = number(node, "alpha", 1), beta = number(node, "beta", 1);
    for (double& weight : dense.weights) weight *= alpha;
    if (!input(node, 2).empty()) {
      if (depends(input(node, 2))) refuse_node("a constant bias", "one that depends on the input");
      dense.bias = channels(input(node, 2), dense.outputs());
      for (double& bias : dense.bias) bias *= beta;
    }
    put_dense(node, std::move(dense));
  }
  void take_matmul(const Node& node) {
    require_inputs(node, 2, 2);
    put_dense(node, weights_of(node, false));
  }

  void take_sum(const Node& node, bool is_difference) {
    require_inputs(node, 2, 2);
    const bool both = depends(input(node, 0)) && depends(input(node, 1));
    if (both) refuse_node("a chain of layers", "two inputs that depend on the graph's (a skip connection)");
    const int runtime = depends(input(node, 0)) ? 0 : 1;
    runtime_input(node, runtime);
    Numbers shift = channels(input(node, 1 - runtime), values_.at(input(node, runtime)).width);
    const double own = is_difference && runtime == 1 ? -1 : 1, other = is_difference && runtime == 0 ? -1 : 1;
    for (double& one : shift) one *= other;
    Value value = values_.at(input(node, runtime));
    const Value of = value;
    for (std::size_t i = 0; i < value.width; ++i) {
      value.scale[i] *= own;
      value.shift[i] = own * value.shift[i] + shift[i];
    }
    // of a plain value the shift goes into the chain: a later product must know its factors as one number
    if (value.inner == Inner::plain) {
      value = plain(value.width, 0, behind(value, affine_step(value.scale, value.shift)));
    }
    put_elementwise(node, of, std::move(value), [own, shift](double v, std::size_t i) { return own * v + shift[i]; });
  }

  void take_product(const Node& node, bool is_quotient) {
    require_inputs(node, 2, 2);
    const bool first = depends(input(node, 0)), second = depends(input(node, 1));
    if (first && second && !is_quotient) return take_gate(node);
    if (first && second) refuse_node("a constant divisor", "one that depends on the input");
    if (is_quotient && !first) refuse_node("a constant divisor", "'" + printable(input(node, 1)) + "'");
    const int runtime = first ? 0 : 1;
    const Value of = runtime_input(node, runtime);
    Numbers factor = channels(input(node, 1 - runtime), of.width);
    for (double& one : factor) {
      if (is_quotient && !(std::abs(one) > 0)) refuse_node("a divisor that is not 0", "0");
      if (is_quotient) one = 1 / one;
    }
    Value value = of;
    for (std::size_t i = 0; i < value.width; ++i) {
      value.scale[i] *= factor[i];
      value.shift[i] *= factor[i];
    }
    put_elementwise(node, of, std::move(value), [factor](double v, std::size_t i) { return v * factor[i]; });
  }

  /// erf(v) or sigmoid(v): what becomes of it is seen behind.
  void take_inner(const Node& node, Inner inner) {
    require_inputs(node, 1, 1);
    Value of = runtime_input(node, 0);
    const double scale = of.scale.front();
    if (of.inner != Inner::plain || !is_uniform(of.scale) || !(std::abs(scale) > 0)) of = made_plain(input(node, 0));
    Value value = plain(of.width, 0, of.chain);
    value.inner = inner;
    value.inner_scale = of.scale.front();
    const ForeignStep sigmoid = activation_step(ForeignActivation::sigmoid);
    put_elementwise(node, of, std::move(value), [inner, sigmoid](double v, std::size_t) {
      return inner == Inner::erf ? std::erf(v) : activated(sigmoid, v);
    });
  }

  /// c b times c' erf(a b) + c' is a GELU of b, c b times c' sigmoid(a b) a SiLU:
  ///   b (1 + erf(a b)) = 2 gelu(k b) / k, k = a sqrt(2);   b sigmoid(a b) = silu(a b) / a
  void take_gate(const Node& node) {
    Value v = runtime_input(node, 0), gate = runtime_input(node, 1);
    const std::size_t slots[] = {v.slot, gate.slot};
    if (v.inner != Inner::plain) std::swap(v, gate);
    bool is_gate =
        v.inner == Inner::plain && v.chain == gate.chain && (gate.inner == Inner::erf || gate.inner == Inner::sigmoid);
    for (std::size_t i = 0; is_gate && i < v.width; ++i) {
      is_gate = gate.inner == Inner::erf ? same(gate.shift[i], gate.scale[i]) : !(std::abs(gate.shift[i]) > 0);
    }
    if (!is_gate) refuse_node("GELU or SiLU", "a product of two numbers that depend on the input");
    const bool is_gelu = gate.inner == Inner::erf;
    const double inside = gate.inner_scale * (is_gelu ? std::sqrt(2.0) : 1), outside = (is_gelu ? 2 : 1) / inside;
    if (!same(inside, 1)) scale_chain(v, inside);
    Value value =
        plain(v.width, 0, behind(v, activation_step(is_gelu ? ForeignActivation::gelu : ForeignActivation::silu)));
    for (std::size_t i = 0; i < v.width; ++i) value.scale[i] = v.scale[i] * gate.scale[i] * outside;
    put(node, std::move(value), [a = slots[0], b = slots[1]](const std::vector<Numbers>& all) {
      Numbers y = all[a];
      for (std::size_t i = 0; i < y.size(); ++i) y[i] *= all[b][i];
      return y;
    });
  }

  void take_batch_norm(const Node& node) {
    require_inputs(node, 5, 5);
    if (whole(node, "training_mode", 0) != 0 || node.output_size() > 1) {
      refuse_node("a network that no longer trains", "a training_mode or batch statistics as outputs");
    }
    runtime_input(node, 0);
    const Value of = made_plain(input(node, 0));
    const Numbers gamma = channels(input(node, 1), of.width), beta = channels(input(node, 2), of.width),
                  mean = channels(input(node, 3), of.width), variance = channels(input(node, 4), of.width);
    const double epsilon = number(node, "epsilon", 1e-5);
    Numbers scale(of.width), shift(of.width);
    for (std::size_t i = 0; i < of.width; ++i) {
      if (!(variance[i] >= 0) || !(variance[i] + epsilon > 0)) {
        refuse_node("variances of 0 or more", std::to_string(variance[i]));
      }
      scale[i] = gamma[i] / std::sqrt(variance[i] + epsilon);
      shift[i] = beta[i] - mean[i] * scale[i];
    }
    Value value = plain(of.width, 0, behind(of, affine_step(scale, shift)));
    put_elementwise(node, of, std::move(value), [=](double v, std::size_t i) {
      return (v - mean[i]) / std::sqrt(variance[i] + epsilon) * gamma[i] + beta[i];
    });
  }

  const std::string& path_;
  const FileBeside& beside_;
  std::map<std::string, std::string> files_;  ///< bytes of files beside the model, by their locations
  std::size_t bytes_ = 0;                     ///< of all of them
  onnx::ModelProto model_;
  std::map<std::string, const onnx::TensorProto*> stored_;
  std::map<std::string, Constant> made_;  ///< of constants by nodes
  std::map<std::string, Value> values_;
  std::vector<Operation> operations_;  ///< the n-th makes slot n + 1; slot 0 is the input
  std::size_t numbers_ = 0;            ///< of weights, and between the nodes
  std::string name_;                   ///< of the node at hand, for messages
};

/// Nodes one after the other, each with the tensors that it takes.
class GraphWriter {
 public:
  explicit GraphWriter(const ExportedNetwork& network) : network_(network) {
    model_.set_ir_version(7);
    model_.set_producer_name("pinnquad");
    model_.set_producer_version(PINNQUAD_VERSION);
    model_.add_opset_import()->set_version(13);
    for (const auto& [word, value] : network.facts) {
      auto* fact = model_.add_metadata_props();
      fact->set_key(word);
      fact->set_value(value);
    }
    graph_ = model_.mutable_graph();
    graph_->set_name(network.name);
    describe(graph_->add_input(), "features", network.inputs);
    write_nodes();
    describe(graph_->add_output(), "commands", network.of_outputs.outputs());
  }

  std::string bytes() const { return model_.SerializeAsString(); }

 private:
  using Names = std::vector<std::string>;

  int type() const { return network_.is_double ? onnx::TensorProto::DOUBLE : onnx::TensorProto::FLOAT; }

  void describe(onnx::ValueInfoProto* value, const char* name, std::size_t width) const {
    value->set_name(name);
    auto* tensor = value->mutable_type()->mutable_tensor_type();
    tensor->set_elem_type(type());
    tensor->mutable_shape()->add_dim()->set_dim_param("rows");
    tensor->mutable_shape()->add_dim()->set_dim_value(static_cast<std::int64_t>(width));
  }

  /// The name of a constant that is added.
  std::string constant(const Numbers& values, const std::vector<std::size_t>& shape) {
    auto* tensor = graph_->add_initializer();
    tensor->set_name("constant_" + std::to_string(graph_->initializer_size()));
    tensor->set_data_type(type());
    for (const std::size_t size : shape) tensor->add_dims(static_cast<std::int64_t>(size));
    for (const double value : values) {
      network_.is_double ? tensor->add_double_data(value) : tensor->add_float_data(static_cast<float>(value));
    }
    return tensor->name();
  }
  std::string row(const Numbers& values) { return constant(values, {values.size()}); }

  /// The name of what the node makes.
  std::string node(const char* op, const Names& inputs) {
    auto* made = graph_->add_node();
    made->set_op_type(op);
    for (const std::string& input : inputs) made->add_input(input);
    made->set_name(std::string(op) + "_" + std::to_string(graph_->node_size()));
    made->add_output(made->name());
    return made->name();
  }
  std::string gemm(const std::string& x, const ForeignDense& dense) {
    const std::string made =
        node("Gemm", {x, constant(dense.weights, {dense.outputs(), dense.inputs}), row(dense.bias)});
    auto* transposed = graph_->mutable_node(graph_->node_size() - 1)->add_attribute();
    transposed->set_name("transB");
    transposed->set_type(onnx::AttributeProto::INT);
    transposed->set_i(1);
    return made;
  }
  std::string gathered(const std::string& x, const std::vector<std::size_t>& places) {
    auto* tensor = graph_->add_initializer();
    tensor->set_name("places_" + std::to_string(graph_->initializer_size()));
    tensor->set_data_type(onnx::TensorProto::INT64);
    tensor->add_dims(static_cast<std::int64_t>(places.size()));
    for (const std::size_t place : places) tensor->add_int64_data(static_cast<std::int64_t>(place));
    const std::string made = node("Gather", {x, tensor->name()});
    auto* axis = graph_->mutable_node(graph_->node_size() - 1)->add_attribute();
    axis->set_name("axis");
    axis->set_type(onnx::AttributeProto::INT);
    axis->set_i(1);
    return made;
  }
  std::string clipped(const std::string& x, const Numbers& lower, const Numbers& upper) {
    return node("Min", {node("Max", {x, row(lower)}), row(upper)});
  }
  std::string activation(const std::string& x, ForeignActivation activation) {
    const auto number = [this](double value) { return constant({value}, {}); };
    switch (activation) {
      case ForeignActivation::relu: return node("Relu", {x});
      case ForeignActivation::tanh: return node("Tanh", {x});
      case ForeignActivation::sigmoid: return node("Sigmoid", {x});
      case ForeignActivation::softplus: return node("Softplus", {x});
      case ForeignActivation::sine: return node("Sin", {x});
      case ForeignActivation::elu: return node("Elu", {x});
      case ForeignActivation::leaky_relu: return node("LeakyRelu", {x});
      case ForeignActivation::relu6:
      case ForeignActivation::hardtanh:
      case ForeignActivation::clip: return node("Clip", {x, number(-clip_bound), number(clip_bound)});
      case ForeignActivation::silu: return node("Mul", {x, node("Sigmoid", {x})});
      case ForeignActivation::gelu: {
        const std::string gate = node("Add", {node("Erf", {node("Div", {x, number(std::sqrt(2.0))})}), number(1)});
        return node("Mul", {node("Mul", {x, gate}), number(0.5)});
      }
    }
    return x;
  }

  void write_nodes() {
    std::string x = "features";
    if (!network_.least.empty()) x = clipped(x, network_.least, network_.most);
    const std::string z = node("Div", {node("Sub", {x, row(network_.mean)}), row(network_.deviation)});
    std::string sum;
    for (const ExportedPart& part : network_.parts) {
      std::string v = part.shown.empty() ? z : gathered(z, part.shown);
      for (const ForeignStep& step : part.steps) {
        v = step.dense.outputs() > 0 ? gemm(v, step.dense) : activation(v, step.activation);
      }
      if (!part.lower.empty()) v = clipped(v, part.lower, part.upper);
      sum = sum.empty() ? v : node("Add", {sum, v});
    }
    std::string u = sum;
    if (network_.scales_outputs()) {
      u = node("Add", {node("Mul", {sum, row(network_.output_deviation)}), row(network_.output_mean)});
    }
    if (!network_.is_plain_output()) u = gemm(u, network_.of_outputs);
    if (!network_.of_features.empty()) {
      const ForeignDense dense{network_.inputs, network_.of_features, Numbers(network_.of_outputs.outputs(), 0)};
      u = node("Add", {u, gemm("features", dense)});
    }
    graph_->mutable_node(graph_->node_size() - 1)->set_output(0, "commands");
  }

  const ExportedNetwork& network_;
  onnx::ModelProto model_;
  onnx::GraphProto* graph_ = nullptr;
};

}  // namespace

std::string onnx_bytes(const ExportedNetwork& network, const std::string& /*path*/) {
  return GraphWriter(network).bytes();
}

ForeignNetwork read_onnx(const std::string& bytes, const std::string& path, const FileBeside& beside) {
  return Graph(bytes, path, beside).network();
}

}  // namespace programs
