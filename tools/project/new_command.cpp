// SPDX-License-Identifier: MIT
// Writes a project of three files that trains, judges and exports a model whose feature set, network, loss and
// optimiser stand in it as types.
//   pinnquad new my_training --model my_model/model.hpp --name MyModel
#include "project/new_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/folders.hpp"
#include "command_line/options.hpp"
#include "model/given_model.hpp"
#include "pinnquad/deploy/airframe_writer.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "project/template.hpp"

namespace {

using namespace pinnquad;
namespace fs = std::filesystem;

struct NewOptions {
  std::string folder;
  std::string airframe;  ///< a name or a file; empty: the model's, or the paper's
  std::string model;     ///< an exported model whose types the project begins with; empty: the paper's
  std::string name;      ///< of the struct that the project exports; empty: the model's
};

/// A place of the template and what goes there.
using Filling = std::vector<std::pair<std::string, std::string>>;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

const std::string library = "pinnquad::";

/// A type in a file that is `using namespace pinnquad`.
std::string short_name(std::string type) {
  replace_all(type, library, "");
  return type;
}

/// A type of the library that a block names.
std::string library_type(const BlockModel& model, const char* word) {
  const std::string type = model.provenance(word);
  const char* known = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_:<>, ";
  if (type.compare(0, library.size(), library) != 0 || type.find_first_not_of(known) != std::string::npos) {
    throw InputError(model.path(), 0, 0, std::string("a model whose ") + word + " are a type of the library",
                     "`" + printable(type) + "`");
  }
  return short_name(type);
}

/// The network of a model: what the project's trainer trains. A structured model is fitted otherwise.
std::string trained_network(const BlockModel& model) {
  const std::string type = library_type(model, "network");
  if (type.compare(0, 8, "Network<") != 0) {
    throw InputError(model.path(), 0, 0, "a network, as pinnquad train --recipe paper exports it", "`" + type + "`");
  }
  return type;
}

/// "Network<float, InputSize<16>, Dense<25>, Relu, Dense<25>, Relu, Dense<4>>" as "Mlp<float, InputSize<16>, Hidden<2,
/// 25>, OutputSize<4>, Relu>"; what has another form stays.
std::string as_mlp(const std::string& network) {
  const std::string head = "Network<", dense = "Dense<";
  std::vector<std::string> parts;
  for (std::size_t begin = head.size(); begin < network.size();) {
    const std::size_t end = std::min(network.find(", ", begin), network.size() - 1);
    parts.push_back(network.substr(begin, end - begin));
    begin = end + 2;
  }
  const bool has_pairs = network.compare(0, head.size(), head) == 0 && parts.size() >= 5 && parts.size() % 2 == 1;
  if (!has_pairs || parts.back().compare(0, dense.size(), dense) != 0) return network;
  for (std::size_t i = 2; i + 1 < parts.size(); ++i) {
    if (parts[i] != parts[i < 4 ? i : i - 2]) return network;
  }
  if (parts[2].compare(0, dense.size(), dense) != 0) return network;
  const auto size = [&](const std::string& layer) {
    return layer.substr(dense.size(), layer.size() - dense.size() - 1);
  };
  return "Mlp<" + parts[0] + ", " + parts[1] + ", Hidden<" + std::to_string((parts.size() - 3) / 2) + ", " +
         size(parts[2]) + ">, OutputSize<" + size(parts.back()) + ">, " + parts[3] + ">";
}

/// The template's text for an airframe of its own, whose struct stands before it.
Filling own_airframe(const std::string& text, const std::string& name) {
  return {{"struct", text},
          {"airframe", "GivenAirframe"},
          {"airframe_value", "{" + name + "::name, airframe_value<" + name + ", double>()}"}};
}
Filling library_airframe(const std::string& type) {
  return {{"struct", ""}, {"airframe", type}, {"airframe_value", "{}"}};
}

std::string struct_of(const std::string& name, const Airframe<double>& airframe) {
  std::ostringstream text;
  write_airframe(text << '\n', "OwnAirframe", name, airframe);
  return text.str();
}

Filling given_airframe(const programs::NamedAirframe& airframe) {
  return own_airframe(struct_of(airframe.name, airframe.value), "OwnAirframe");
}

/// That of a name or a file.
Filling chosen_airframe(const std::string& name_or_file) {
  Filling places;
  programs::with_airframe(name_or_file, [&places](auto tag) {
    places = library_airframe(short_name(type_name<typename decltype(tag)::type>()));
  });
  return places.empty() ? given_airframe(programs::chosen_airframe(name_or_file)) : places;
}

/// That of a model: one of the library, where all its numbers are.
Filling airframe_of(const BlockModel& model) {
  const std::string name = model.airframe_name(), own = struct_of(name, model.airframe());
  Filling places = own_airframe(own, "OwnAirframe");
  programs::with_airframe(name, [&](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    if (struct_of(name, airframe_value<Vehicle, double>()) == own) {
      places = library_airframe(short_name(type_name<Vehicle>()));
    }
  });
  return places;
}

/// Values for the places of the template.
Filling filling(const NewOptions& options) {
  std::string name = "TrainedQuadModel", airframe = options.airframe;
  Filling places, types = {{"features", "PaperFeatures"},
                           {"outputs", "CommandOutputs"},
                           {"network", "Mlp<float, InputSize<MyFeatures::size>, Hidden<10, 25>, OutputSize<4>, Relu>"}};
  if (!options.model.empty()) {
    const BlockModel model = programs::read_model(options.model);
    if (airframe.empty()) places = airframe_of(model);
    types = {{"features", library_type(model, "features")},
             {"outputs", library_type(model, "outputs")},
             {"network", as_mlp(trained_network(model))}};
    name = model.name();
  }
  if (places.empty()) places = chosen_airframe(airframe.empty() ? PaperQuadrotor::name : airframe);
  if (!options.name.empty()) name = options.name;
  require_identifier("--name", name);
  places.insert(places.end(), types.begin(), types.end());
  places.emplace_back("name", name);
  places.emplace_back("version", std::to_string(PINNQUAD_VERSION_MAJOR) + "." + std::to_string(PINNQUAD_VERSION_MINOR));
  return places;
}

/// Makes a folder that holds nothing; takes it away again, with those above it that it made, if nothing came into it.
class EmptyFolder {
 public:
  /// Throws OutputError, one line.
  explicit EmptyFolder(const std::string& path) : path_(fs::path(path).lexically_normal()) {
    std::error_code error;
    for (fs::path above = path_; !above.empty() && !fs::exists(above, error); above = above.parent_path()) {
      made_.push_back(above);
    }
    if (made_.empty() && fs::is_directory(path_, error) && !fs::is_empty(path_, error)) {
      throw OutputError(path, "it is not empty; a new folder was expected");
    }
    programs::make_folders(path);
  }
  EmptyFolder(const EmptyFolder&) = delete;
  EmptyFolder& operator=(const EmptyFolder&) = delete;
  ~EmptyFolder() {
    std::error_code ignored;
    for (const fs::path& folder : made_) fs::remove(folder, ignored);
  }

 private:
  fs::path path_;
  std::vector<fs::path> made_;  ///< the innermost first
};

int write_project(const NewOptions& options) {
  const Filling places = filling(options);
  const EmptyFolder folder(options.folder);
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (const programs::TemplateFile& file : programs::project_template()) {
    std::string text = file.text;
    for (const auto& [place, filled] : places) replace_all(text, "{{" + place + "}}", filled);
    files.push_back(std::make_unique<AtomicFile>((fs::path(options.folder) / file.name).string()));
    files.back()->stream() << text;
  }
  for (const auto& file : files) file->close();
  for (const auto& file : files) file->commit();
  const std::string shown = printable(options.folder);
  std::printf(
      "%s: CMakeLists.txt, model.hpp (what is trained: edit it), main.cpp\n"
      "  cmake -G Ninja -S %s -B %s/build && cmake --build %s/build\n"
      "  %s/build/train flight.csv trained.hpp\n",
      shown.c_str(), shown.c_str(), shown.c_str(), shown.c_str(), shown.c_str());
  return 0;
}

}  // namespace

programs::Command programs::new_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "new", "Writes a small project that trains: feature set, network, loss, schedule, optimiser as types to edit");
  const auto options = std::make_shared<NewOptions>();
  add_path(*line, "folder", options->folder, "FOLDER", "where to write it: not there yet, or empty")->required();
  add_path(*line, "--airframe", options->airframe, "NAME|FILE.toml",
           "what flies: a file (examples/airframes), or one of: " + airframe_names() + " (default: that of MODEL, or " +
               pinnquad::PaperQuadrotor::name + ")");
  add_path(*line, "--model", options->model, "MODEL",
           "begin with features, network and airframe of this exported model, no structured one (default: the "
           "paper's)");
  add_path(*line, "--name", options->name, "NAME",
           "name of the struct that the project exports (default: that of MODEL, or TrainedQuadModel)");
  line->footer(
      "Examples:\n"
      "  pinnquad new my_training --airframe mine.toml\n"
      "  pinnquad new my_training --model my_model/model.hpp --name MyModel\n"
      "  cmake -G Ninja -S my_training -B my_training/build && cmake --build my_training/build\n"
      "  my_training/build/train flight.csv trained.hpp\n"
      "CMake finds an installed pinnquad whose program is in the PATH, or by -DCMAKE_PREFIX_PATH=PREFIX.\n"
      "Exit codes: 0; 2 bad input, a folder that is not empty, or a file that can't be read or written.");
  return {line, [options] { return write_project(*options); }};
}
