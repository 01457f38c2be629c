// SPDX-License-Identifier: MIT
#include "convert/safetensors.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "convert/stored_number.hpp"
#include "logs/nesting.hpp"
#include "pinnquad/io/file_error.hpp"

namespace programs {
namespace {

using pinnquad::InputError;
using pinnquad::printable;

constexpr std::size_t length_bytes = 8;
constexpr std::uint64_t longest_header = 1 << 24;

std::uint64_t read_length(const std::string& bytes) {
  std::uint64_t length = 0;
  for (std::size_t i = length_bytes; i > 0; --i) length = length << 8 | static_cast<unsigned char>(bytes[i - 1]);
  return length;
}

template <class Bits, class Number>
void append_number(Number number, std::string& to) {
  static_assert(sizeof(Bits) == sizeof(Number));
  Bits bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  for (std::size_t i = 0; i < sizeof bits; ++i) to += static_cast<char>(bits >> (8 * i) & 0xff);
}

const std::map<std::string, StoredNumber> number_types = {{"F64", StoredNumber::float64},
                                                          {"F32", StoredNumber::float32},
                                                          {"F16", StoredNumber::float16},
                                                          {"BF16", StoredNumber::bfloat16}};

/// A tensor of the header: where its bytes are.
struct Placed {
  std::string name, type;
  std::vector<std::size_t> shape;
  std::uint64_t begin = 0, end = 0;
  std::uint64_t count = 1;
};

class Header {
 public:
  Header(const std::string& bytes, const std::string& path) : path_(path) {
    if (bytes.size() < length_bytes) refuse("a safetensors file", "one of " + std::to_string(bytes.size()) + " bytes");
    const std::uint64_t length = read_length(bytes);
    if (length > longest_header) {
      refuse("a safetensors header of at most 16 MiB", "a length of " + std::to_string(length) + " bytes");
    }
    if (length > bytes.size() - length_bytes) {
      refuse("a header of " + std::to_string(length) + " bytes", "a file that is cut short");
    }
    first_ = length_bytes + static_cast<std::size_t>(length);
    data_bytes_ = bytes.size() - first_;
    read(bytes.substr(length_bytes, static_cast<std::size_t>(length)));
  }

  /// By their places in the file.
  const std::vector<Placed>& tensors() const { return tensors_; }
  std::size_t first() const { return first_; }

 private:
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw InputError(path_, 0, 0, expected, found);
  }

  void read(const std::string& text) {
    pinnquad::logs::require_shallow(text, path_, "JSON");
    std::string twice;
    std::vector<std::set<std::string>> keys;
    const auto see = [&](int /*depth*/, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
      if (event == nlohmann::json::parse_event_t::object_start) keys.emplace_back();
      if (event == nlohmann::json::parse_event_t::object_end) keys.pop_back();
      if (event == nlohmann::json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second) {
        twice = parsed.get<std::string>();
      }
      return true;
    };
    const nlohmann::json all = nlohmann::json::parse(text.begin(), text.end(), see, false);
    if (all.is_discarded() || !all.is_object()) refuse("a JSON object as the header", "none");
    if (!twice.empty()) refuse("each name once in the header", "'" + printable(twice) + "' twice");
    for (const auto& [name, entry] : all.items()) {
      if (name != "__metadata__") tensors_.push_back(placed(name, entry));
    }
    require_places();
  }

  Placed placed(const std::string& name, const nlohmann::json& entry) const {
    const std::string what = "tensor '" + printable(name) + "': ";
    if (!entry.is_object()) refuse(what + "an object with dtype, shape and data_offsets", entry.type_name());
    Placed tensor;
    tensor.name = name;
    const auto dtype = entry.find("dtype"), shape = entry.find("shape"), offsets = entry.find("data_offsets");
    if (dtype == entry.end() || !dtype->is_string()) refuse(what + "a text dtype", "none");
    tensor.type = dtype->get<std::string>();
    constexpr std::string_view counter = "num_batches_tracked";  // of BatchNorm1d, and nothing that a network answers
    const bool counts = name.size() >= counter.size() && name.substr(name.size() - counter.size()) == counter;
    const auto known = number_types.find(tensor.type);
    if (known == number_types.end() && !(tensor.type == "I64" && counts)) {
      refuse(what + "numbers of type F64, F32, F16 or BF16", printable(tensor.type));
    }
    if (shape == entry.end() || !shape->is_array()) refuse(what + "an array shape", "none");
    for (const auto& size : *shape) {
      if (!size.is_number_unsigned() || size.get<std::uint64_t>() > (1u << 28)) {
        refuse(what + "sizes from 0 to 2^28", size.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
      }
      tensor.shape.push_back(size.get<std::size_t>());
      tensor.count *= size.get<std::uint64_t>();
      if (tensor.count > (1u << 28)) refuse(what + "at most 2^28 numbers", "more");
    }
    if (offsets == entry.end() || !offsets->is_array() || offsets->size() != 2 || !(*offsets)[0].is_number_unsigned() ||
        !(*offsets)[1].is_number_unsigned()) {
      refuse(what + "two data_offsets", "others");
    }
    tensor.begin = (*offsets)[0].get<std::uint64_t>();
    tensor.end = (*offsets)[1].get<std::uint64_t>();
    const std::string range = "[" + std::to_string(tensor.begin) + ", " + std::to_string(tensor.end) + "]";
    if (tensor.begin > tensor.end || tensor.end > data_bytes_) {
      refuse(what + "data_offsets within the " + std::to_string(data_bytes_) + " bytes of data", range);
    }
    const std::uint64_t bytes = tensor.count * (known == number_types.end() ? 8 : bytes_of(known->second));
    if (tensor.end - tensor.begin != bytes) {
      refuse(what + std::to_string(bytes) + " bytes for its shape", range);
    }
    return tensor;
  }

  void require_places() {
    std::sort(tensors_.begin(), tensors_.end(),
              [](const Placed& a, const Placed& b) { return a.begin != b.begin ? a.begin < b.begin : a.end < b.end; });
    std::uint64_t at = 0;
    for (const Placed& tensor : tensors_) {
      if (tensor.begin != at) {
        refuse("tensors one after the other",
               "'" + printable(tensor.name) + "' " + (tensor.begin < at ? "over the one before" : "behind a hole"));
      }
      at = tensor.end;
    }
    if (at != data_bytes_) refuse(std::to_string(at) + " bytes of data", std::to_string(data_bytes_));
  }

  const std::string& path_;
  std::vector<Placed> tensors_;
  std::size_t first_ = 0, data_bytes_ = 0;
};

/// A module of a Sequential: tensors by what follows its number.
using Module = std::map<std::string, const Tensor*>;

std::string shape_text(const Tensor& tensor) {
  std::string text = "[";
  for (std::size_t i = 0; i < tensor.shape.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(tensor.shape[i]);
  return text + "]";
}

/// An operator of the source, and the step that is made of it.
struct SourceModule {
  std::function<Numbers(const Numbers&)> apply;
  ForeignStep step;
};

class Sequential {
 public:
  Sequential(const Tensors& tensors, const std::string& path, const ForeignMeaning& meaning)
      : path_(path), meaning_(meaning) {
    take_modules(tensors);
  }

  ForeignNetwork network() {
    auto chain = std::make_shared<std::vector<SourceModule>>();
    const int last = modules_.rbegin()->first;
    for (int number = 0; number <= last; ++number) {
      const auto module = modules_.find(number);
      if (module != modules_.end()) {
        chain->push_back(module->second.count("running_mean") ? batch_norm(number, module->second)
                                                              : linear(number, module->second));
      } else {
        add_activation(*chain, "module " + std::to_string(number));
      }
    }
    // those behind the last module with numbers
    while (!meaning_.one_activation && next_activation_ < meaning_.activations.size()) {
      if (next_activation_ + 1 < meaning_.activations.size()) refuse_activations();
      add_activation(*chain, "");
    }
    ForeignNetwork network;
    network.inputs = inputs_;
    network.outputs = width_;
    for (const SourceModule& module : *chain) network.steps.push_back(module.step);
    network.evaluate = [chain](const Numbers& x) {
      Numbers y = x;
      for (const SourceModule& module : *chain) y = module.apply(y);
      return y;
    };
    return network;
  }

 private:
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw InputError(path_, 0, 0, expected, found);
  }
  [[noreturn]] void refuse_activations() const {
    throw InputError(meaning_.path, 0, 0,
                     "activations for the " + std::to_string(gaps_) + " modules of " + printable(path_) +
                         " that have no numbers, and at most one behind them",
                     std::to_string(meaning_.activations.size()));
  }

  /// "3.weight", all behind one prefix or none.
  void take_modules(const Tensors& tensors) {
    std::optional<std::string> prefix;
    for (const auto& [name, tensor] : tensors) {
      const std::size_t dot = name.rfind('.');
      const std::size_t before = dot == std::string::npos || dot == 0 ? std::string::npos : name.rfind('.', dot - 1);
      const std::size_t begin = before == std::string::npos ? 0 : before + 1;
      int number = -1;
      if (dot != std::string::npos) {
        const char *first = name.data() + begin, *end = name.data() + dot;
        const auto read = std::from_chars(first, end, number);
        if (read.ec != std::errc() || read.ptr != end) number = -1;
      }
      if (number < 0 || number > 999) {
        refuse("tensors as torch.nn.Sequential names them (0.weight, 0.bias, 2.weight, ...)",
               "'" + printable(name) + "'");
      }
      if (!prefix) prefix = name.substr(0, begin);
      if (*prefix != name.substr(0, begin)) {
        refuse("the tensors of one torch.nn.Sequential",
               "'" + printable(name) + "' beside '" + printable(*prefix) + "'");
      }
      if (!modules_[number].emplace(name.substr(dot + 1), &tensor).second) {
        refuse("each tensor once", "'" + printable(name) + "' again");
      }
    }
    if (modules_.empty()) refuse("tensors of a network", "none");
    gaps_ = modules_.rbegin()->first + 1 - static_cast<int>(modules_.size());
  }

  const Tensor* tensor_of(int number, const Module& module, const char* name, std::vector<std::size_t> shape) const {
    const auto found = module.find(name);
    if (found == module.end()) return nullptr;
    const Tensor& tensor = *found->second;
    Tensor expected;
    expected.shape = std::move(shape);
    if (tensor.shape != expected.shape) {
      refuse("'" + std::to_string(number) + "." + name + "' of shape " + shape_text(expected), shape_text(tensor));
    }
    return &tensor;
  }
  void require_known(int number, const Module& module, const std::set<std::string>& known) const {
    for (const auto& [name, tensor] : module) {
      if (known.count(name) == 0) {
        refuse("numbers of Linear or BatchNorm1d",
               "'" + std::to_string(number) + "." + printable(name) + "' of shape " + shape_text(*tensor));
      }
    }
  }

  SourceModule linear(int number, const Module& module) {
    require_known(number, module, {"weight", "bias"});
    const auto found = module.find("weight");
    if (found == module.end() || found->second->shape.size() != 2) {
      refuse("'" + std::to_string(number) + ".weight' of two dimensions, of Linear",
             found == module.end() ? "none" : "shape " + shape_text(*found->second));
    }
    const std::size_t outputs = found->second->shape[0], inputs = found->second->shape[1];
    if (outputs == 0 || inputs == 0) refuse("'" + std::to_string(number) + ".weight' with numbers", "none");
    if (inputs_ == 0) inputs_ = width_ = inputs;
    tensor_of(number, module, "weight", {outputs, width_});
    const Tensor* bias = tensor_of(number, module, "bias", {outputs});
    const ForeignStep step = dense_step({inputs, found->second->values, bias ? bias->values : Numbers(outputs, 0)});
    width_ = outputs;
    return {[step](const Numbers& x) { return taken(step, x); }, step};
  }

  SourceModule batch_norm(int number, const Module& module) {
    require_known(number, module, {"weight", "bias", "running_mean", "running_var", "num_batches_tracked"});
    const std::size_t size = module.at("running_mean")->values.size();
    if (inputs_ == 0) inputs_ = width_ = size;
    const Tensor* mean = tensor_of(number, module, "running_mean", {width_});
    const Tensor* variance = tensor_of(number, module, "running_var", {width_});
    const Tensor* gamma = tensor_of(number, module, "weight", {width_});
    const Tensor* beta = tensor_of(number, module, "bias", {width_});
    if (!variance) refuse("'" + std::to_string(number) + ".running_var'", "none");
    constexpr double epsilon = 1e-5;  // PyTorch's, which a state_dict does not say
    for (const double v : variance->values) {
      if (v < 0) refuse("variances of 0 or more in '" + std::to_string(number) + ".running_var'", std::to_string(v));
    }
    const Numbers m = mean->values, v = variance->values, g = gamma ? gamma->values : Numbers(width_, 1),
                  b = beta ? beta->values : Numbers(width_, 0);
    Numbers scale(width_), shift(width_);
    for (std::size_t i = 0; i < width_; ++i) {
      scale[i] = g[i] / std::sqrt(v[i] + epsilon);
      shift[i] = b[i] - m[i] * scale[i];
    }
    return {[=](const Numbers& x) {
              Numbers y(x.size());
              for (std::size_t i = 0; i < x.size(); ++i) y[i] = (x[i] - m[i]) / std::sqrt(v[i] + epsilon) * g[i] + b[i];
              return y;
            },
            affine_step(scale, shift)};
  }

  /// The next that the features file names.
  void add_activation(std::vector<SourceModule>& chain, const std::string& module) {
    const std::size_t place = meaning_.one_activation ? 0 : next_activation_++;
    if (place >= meaning_.activations.size()) {
      throw InputError(
          meaning_.path, 0, 0,
          "`activations`, one for each of the " + std::to_string(gaps_) + " modules of " + printable(path_) +
              " that have no numbers",
          meaning_.activations.empty() ? "none for " + module : std::to_string(meaning_.activations.size()));
    }
    const std::optional<ForeignActivation> activation = meaning_.activations[place];
    if (!activation) return;
    const ForeignStep step = activation_step(*activation);
    chain.push_back({[step](const Numbers& x) { return taken(step, x); }, step});
  }

  const std::string& path_;
  const ForeignMeaning& meaning_;
  std::map<int, Module> modules_;
  std::size_t inputs_ = 0, width_ = 0;
  int gaps_ = 0;
  std::size_t next_activation_ = 0;
};

}  // namespace

Tensors read_safetensors(const std::string& bytes, const std::string& path) {
  const Header header(bytes, path);
  Tensors tensors;
  for (const Placed& placed : header.tensors()) {
    Tensor tensor;
    tensor.shape = placed.shape;
    const char* at = bytes.data() + header.first() + placed.begin;
    if (placed.type != "I64") {
      const StoredNumber type = number_types.at(placed.type);
      tensor.values.reserve(static_cast<std::size_t>(placed.count));
      for (std::uint64_t i = 0; i < placed.count; ++i, at += bytes_of(type)) {
        const double value = number_at(at, type);
        if (!std::isfinite(value)) {
          throw InputError(path, 0, 0, "finite numbers in '" + printable(placed.name) + "'",
                           std::isnan(value) ? "NaN" : "Inf");
        }
        tensor.values.push_back(value);
      }
    }
    tensors.emplace(placed.name, std::move(tensor));
  }
  return tensors;
}

ForeignNetwork safetensors_network(const Tensors& tensors, const std::string& path, const ForeignMeaning& meaning) {
  return Sequential(tensors, path, meaning).network();
}

std::string safetensors_bytes(const std::vector<std::pair<std::string, Tensor>>& tensors, bool is_double,
                              const std::map<std::string, std::string>& metadata) {
  nlohmann::json header = nlohmann::json::object();
  header["__metadata__"] = metadata;
  std::string data;
  for (const auto& [name, tensor] : tensors) {
    const std::size_t begin = data.size();
    for (const double value : tensor.values) {
      if (is_double) {
        append_number<std::uint64_t>(value, data);
      } else {
        append_number<std::uint32_t>(static_cast<float>(value), data);
      }
    }
    header[name] = {
        {"dtype", is_double ? "F64" : "F32"}, {"shape", tensor.shape}, {"data_offsets", {begin, data.size()}}};
  }
  std::string text = header.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.resize((text.size() + 7) / 8 * 8, ' ');
  std::string bytes;
  append_number<std::uint64_t>(static_cast<std::uint64_t>(text.size()), bytes);
  return bytes + text + data;
}

}  // namespace programs
