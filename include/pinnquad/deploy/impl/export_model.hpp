// SPDX-License-Identifier: MIT
// Bodies of export_model.hpp.
#pragma once

#include "pinnquad/deploy/export_model.hpp"

namespace pinnquad {

PINNQUAD_BODY Provenance provenance_of(const Dataset& flights, const RowSplit& split, std::uint64_t seed, int epochs,
                                       const std::string& loss, const Verdict& verdict) {
  Provenance from{flight_names(flights), content_hash(flights), split.train.size(), seed, epochs, loss, verdict};
  from.sample_period_s = sample_period_s(split.train);
  return from;
}

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

#ifdef PINNQUAD_COMPILED
template Exported export_model(const Exported::Files&, const std::string&, const GroundModel<float>&, const RowSplit&,
                               Provenance);
template Exported export_model(const Exported::Files&, const std::string&, const GroundModel<double>&, const RowSplit&,
                               Provenance);
#endif

}  // namespace pinnquad
