// SPDX-License-Identifier: MIT
#include "convert/convert_network.hpp"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "command_line/folder_lock.hpp"
#include "command_line/in_columns.hpp"
#include "command_line/in_words.hpp"
#include "convert/converted_model.hpp"
#include "convert/exported_network.hpp"
#include "convert/features_file.hpp"
#include "convert/python_answer.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/io/atomic_file.hpp"

namespace programs {
namespace {

using namespace pinnquad;

[[noreturn]] void refuse_difference(const Conversion& conversion, double difference) {
  throw InputError(
      conversion.source, 0, 0, "a network that the model's arithmetic answers within 1e-5 of a command",
      in_words("a difference of %.1e", difference) + (conversion.in_double ? "" : " (--double has more digits)"));
}

/// Largest difference of a block's golden commands, which its weights may not give: BlockModel refuses such a one.
template <class Scalar>
double golden_difference(const std::vector<unsigned char>& block) {
  std::vector<std::uint64_t> aligned((block.size() + 7) / 8);
  std::memcpy(aligned.data(), block.data(), block.size());
  const auto model = std::make_unique<RunTimeModel<Scalar>>();
  if (RunTimeModel<Scalar>::open(aligned.data(), block.size(), *model) != Status::ok) return 0;  // it says why
  std::vector<Scalar> work(model->workspace());
  return static_cast<double>(model->golden_difference(work.data()));
}

/// Reads the widths of a chain against the file's. Throws InputError.
void require_widths(const ForeignNetwork& network, const ForeignMeaning& meaning) {
  if (network.inputs != meaning.features.size()) {
    throw InputError(
        meaning.path, 0, 0,
        "a feature for each of the " + std::to_string(network.inputs) + " numbers that " + network.source + " reads",
        std::to_string(meaning.features.size()) + " features");
  }
  if (network.outputs != meaning.outputs.size()) {
    throw InputError(
        meaning.path, 0, 0,
        "an output for each of the " + std::to_string(network.outputs) + " numbers that " + network.source + " makes",
        std::to_string(meaning.outputs.size()) + " outputs" + (meaning.outputs.size() == 4 ? " ([output] names)" : ""));
  }
}

template <class Scalar>
std::string write_model(const Conversion& conversion, const ForeignMeaning& meaning, const AskPython& ask) {
  const AskedRows rows = asked_rows<Scalar>(meaning);
  const nlohmann::json request = {{"source", conversion.source},        {"rows", rows.of_network},
                                  {"activations", meaning.activations}, {"one_activation", meaning.one_activation},
                                  {"layers", meaning.layers},           {"features_path", meaning.path},
                                  {"prefix", conversion.prefix},        {"output", conversion.output}};
  ForeignNetwork network = asked_network(ask, request.dump(), conversion.source);
  network.source = printable(std::filesystem::path(conversion.source).filename().string());
  require_widths(network, meaning);
  pinnquad::detail::WrittenModel<Scalar> written = converted_model<Scalar>(network, meaning, rows, conversion.name);
  const std::string block_path = conversion.out + "/model.block", header_path = conversion.out + "/model.hpp";
  const std::vector<unsigned char> block = pinnquad::detail::block_beside_header(written);
  const double golden = golden_difference<Scalar>(block);
  if (!(golden <= golden_tolerance)) refuse_difference(conversion, golden);
  const BlockModel model(block_path, block);
  const double difference = largest_difference(model, network, meaning, rows);
  if (!(difference <= converted_tolerance)) refuse_difference(conversion, difference);
  if (!model.angular_accelerations().empty()) {
    if (const auto proven = model.proven_signs()) {
      written.proven_slopes = {proven->held_slope[0], proven->held_slope[1], proven->held_slope[2]};
    } else {
      written.signs_unproven = true;
    }
  }
  const FolderLock folder(conversion.out);
  AtomicFile header_file(header_path), block_file(block_path);
  header_file.stream() << pinnquad::detail::header_text(written);
  pinnquad::detail::write_block(block_file.stream(), block);
  header_file.close();
  block_file.close();
  header_file.commit();
  block_file.commit();
  return entry("files", printable(header_path) + ": struct " + conversion.name + ", " +
                            std::to_string(model.network().parameter_count()) + " parameters") +
         entry("", printable(block_path) + ": " + std::to_string(block.size()) + " bytes") +
         entry("checked", "at most " + in_words("%.1e", difference) + " from the source's commands, over " +
                              std::to_string(model.golden_count()) +
                              " golden vectors and 1000 motions inside the envelope");
}

}  // namespace

std::string convert_network(const Conversion& conversion, const AskPython& ask) {
  require_identifier("--name", conversion.name);
  const ForeignMeaning meaning = read_features_file(conversion.features);
  return conversion.in_double ? write_model<double>(conversion, meaning, ask)
                              : write_model<float>(conversion, meaning, ask);
}

std::string network_of(const BlockModel& model, const std::string& ending, const AskPython& ask) {
  const nlohmann::json request = {{"model", exported_network(model)}, {"ending", ending}};
  // its bytes as the characters 0 to 255
  const std::string text = python_answer(ask, request.dump(), model.path()).at("bytes").get<std::string>();
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto first = static_cast<unsigned char>(text[i]);
    bytes += first < 0x80 ? text[i] : static_cast<char>((first & 0x03) << 6 | (text[++i] & 0x3f));
  }
  return bytes;
}

}  // namespace programs
