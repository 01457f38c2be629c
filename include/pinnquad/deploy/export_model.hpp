// SPDX-License-Identifier: MIT
// Exports a trained model whole: its header with the certificate, its block, its limits of trust. None
// appears before all are written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "pinnquad/core/body.hpp"
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
Provenance provenance_of(const Dataset& flights, const RowSplit& split, std::uint64_t seed, int epochs,
                         const std::string& loss, const Verdict& verdict);

/// Writes `struct <name>` and, to be included after it, `struct <name>Trust`. Golden vectors are of the training rows.
/// Validation rows that are too few for limits of trust are no error: then the trust file of an earlier export is
/// removed. Throws what write_model() and AtomicFile throw; no file has changed then.
template <class Scalar>
Exported export_model(const Exported::Files& files, const std::string& name, const GroundModel<Scalar>& model,
                      const RowSplit& split, Provenance provenance);
/// The same for a model whose types are known.
template <class NetworkType, class ContextType>
Exported export_model(const Exported::Files& files, const std::string& name,
                      const TrainedModel<NetworkType, ContextType>& model, const RowSplit& split,
                      const Provenance& provenance) {
  return export_model(files, name, ground_model(model), split, provenance);
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

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/export_model.hpp"
#endif
