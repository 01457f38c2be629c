// SPDX-License-Identifier: MIT
// Exports a trained model whole: its header with the certificate, its block, its limits of trust. All files appear, or
// none.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/deploy/golden_features.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/trust_writer.hpp"
#include "pinnquad/deploy/weight_file.hpp"

namespace pinnquad {

/// The result of an export, beside its files.
struct Exported {
  /// Their paths. A block and limits of trust without a path are not written.
  struct Files {
    std::string header, block, trust;
  };

  std::optional<Certificate> certificate{};  ///< none: the model has no structure that could be proven
  std::size_t block_bytes = 0;               ///< 0: no block was written
  std::string no_trust_because{};            ///< empty: limits of trust were written, or not asked for
};

/// The provenance of a model that was trained on the split of a dataset. `loss`: in words.
inline Provenance provenance_of(const Dataset& flights, const RowSplit& split, std::uint64_t seed, int epochs,
                                const std::string& loss, const Verdict& verdict) {
  Provenance from{flight_names(flights), content_hash(flights), split.train.size(), seed, epochs, loss, verdict};
  from.sample_period_s = sample_period_s(split.train);
  return from;
}

/// Writes `struct <name>` and, to be included after it, `struct <name>Trust`. Golden vectors are of the training rows.
/// Validation rows that are too few for limits of trust are no error: then the trust file of an earlier export is
/// removed. Throws what write_model() and AtomicFile throw; no file has changed then.
template <class Scalar>
Exported export_model(const Exported::Files& files, const std::string& name, const GroundModel<Scalar>& model,
                      const RowSplit& split, Provenance provenance) {
  if (model.window_s > 0) provenance.sample_period_s = 0;  // a window has its own
  Exported result;
  result.certificate = model.written.certificate;
  const auto golden = golden_features(model, split.train);
  AtomicFile header(files.header);
  write_model(header.stream(), name, model, golden, provenance);
  std::optional<AtomicFile> block, trust;
  std::optional<FittedTrust> limits;
  if (!files.trust.empty()) {
    try {
      limits = fit_trust(model, split.train, split.validation);
      trust.emplace(files.trust);
      trust->stream() << "// To be included after the header of " << name << ". Limits by " << split.validation.size()
                      << " validation rows: guesses where those are\n// less than 30 minutes of flight "
                         "(docs/trust.md).\n#pragma once\n\n#include <array>\n#include <cstdint>\n";
      write_trust<Scalar>(trust->stream(), name, *limits, provenance.training_data_hash);
    } catch (const std::invalid_argument& refused) {
      result.no_trust_because = refused.what();
      trust.reset();
      limits.reset();
    }
  }
  if (!files.block.empty()) {
    const std::vector<unsigned char> bytes = model_block(model, golden, provenance, name, limits ? &*limits : nullptr);
    block.emplace(files.block);
    detail::write_block(block->stream(), bytes);
    result.block_bytes = bytes.size();
  }
  for (std::optional<AtomicFile>* file : {&block, &trust}) {
    if (*file) (*file)->close();
  }
  header.commit();
  for (std::optional<AtomicFile>* file : {&block, &trust}) {
    if (*file) (*file)->commit();
  }
  std::error_code ignored;
  if (!result.no_trust_because.empty()) std::filesystem::remove(files.trust, ignored);
  return result;
}
/// The same for a model whose types are known.
template <class NetworkType, class ContextType>
Exported export_model(const Exported::Files& files, const std::string& name,
                      const TrainedModel<NetworkType, ContextType>& model, const RowSplit& split,
                      const Provenance& provenance) {
  return export_model(files, name, ground_model(model), split, provenance);
}

/// The same of the model that a fit chose.
template <class... Models>
Exported export_model(const Exported::Files& files, const std::string& name, const std::variant<Models...>& model,
                      const RowSplit& split, const Provenance& provenance) {
  return std::visit([&](const auto& chosen) { return export_model(files, name, chosen, split, provenance); }, model);
}

/// Into a folder, made if it is not there: model.hpp, model.block, trust.hpp.
template <class Model>
Exported export_model(const std::string& folder, const std::string& name, const Model& model, const RowSplit& split,
                      const Provenance& provenance) {
  std::filesystem::create_directories(folder);
  return export_model(Exported::Files{folder + "/model.hpp", folder + "/model.block", folder + "/trust.hpp"}, name,
                      model, split, provenance);
}

}  // namespace pinnquad
