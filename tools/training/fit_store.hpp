// SPDX-License-Identifier: MIT
// Finished fits in a folder, so that a training that was interrupted goes on where it was: what each answered, not the
// model itself, which the same rows and seed give again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/build_facts.hpp"
#include "command_line/folders.hpp"
#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "training/fits.hpp"

namespace pinnquad {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BiasTrial, rows, absolute)
}

namespace programs {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DerivativeFigures, wrong_share, least, median, sees_acceleration)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AltitudeChoice, applies, taken, error_with, error_without)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GuardCounts, rows, warming_up, outside_envelope, output_not_finite, beyond_limits,
                                   furthest)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FinishedFit, validation_mae, fit_s, biases, looks_ahead_s, derivatives, altitude,
                                   proven, held_out, chosen_by, guard)

/// Files in CBOR.
class FitStore : public KnownFits {
 public:
  /// The folder is made when the first fit comes.
  FitStore(std::string folder, const FitPlan& plan)
      : folder_(std::move(folder)), plan_(plan), of_plan_(plan_hash(plan)) {}

  /// Fills a job that an earlier run of this very program has finished on the same rows. False if there is none; a file
  /// that is not whole, or of another training, is none.
  bool load(FinishedFit& job) const override {
    std::ifstream file(path_of(job), std::ios::binary);
    try {
      const auto [key, kept] = nlohmann::json::from_cbor(file).get<std::pair<std::uint64_t, nlohmann::json>>();
      FinishedFit loaded = job;
      kept.get_to(loaded);
      if (key != key_of(job) || loaded.held_out.size() != plan_.folds[job.fold].split.test.size()) return false;
      job = std::move(loaded);
      return true;
    } catch (const nlohmann::json::exception&) {
      return false;
    }
  }

  /// Throws OutputError.
  void keep(const FinishedFit& job) const override {
    make_folders(folder_);
    pinnquad::AtomicFile file(path_of(job));
    nlohmann::json::to_cbor(std::make_pair(key_of(job), nlohmann::json(job)), file.stream());
    file.commit();
  }

  /// All files of fits: once the training is whole, they have served.
  void clear() const {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
      if (entry.path().extension() == ".fit") std::filesystem::remove(entry.path(), ignored);
    }
    std::filesystem::remove(folder_, ignored);  // if nothing else is in it
  }

 private:
  /// The program, the airframe, what the flights lack, what was asked for.
  static std::uint64_t plan_hash(const FitPlan& plan) {
    pinnquad::detail::Fnv1a fnv;
    fnv.absorb_word(program_hash());
    fnv.absorb_word(pinnquad::detail::constant_hash("airframe", plan.airframe.value));
    for (const std::string& name : plan.absent) fnv.absorb_text(name);
    for (const double value : {plan.sample_period_s, plan.past.delay_s, plan.past.least_time_constant_s}) {
      pinnquad::detail::absorb_number(fnv, value);
    }
    fnv.absorb_word(static_cast<std::uint64_t>(plan.epochs));
    const FitSettings& asked = plan.settings;
    for (const int word : {int{asked.library_airframe}, asked.altitude ? 1 + int{*asked.altitude} : 0,
                           int{asked.pinned_slopes}, int{asked.fit_validation}}) {
      fnv.absorb_word(static_cast<std::uint64_t>(word));
    }
    return fnv.hash;
  }

  std::uint64_t key_of(const FinishedFit& job) const {
    pinnquad::detail::Fnv1a fnv;
    fnv.absorb_word(of_plan_);
    fnv.absorb_text(plan_.kinds[job.kind].key);
    fnv.absorb_word(job.seed);
    const Fold& fold = plan_.folds[job.fold];
    std::vector<const pinnquad::RowSet*> all = {&fold.split.train, &fold.split.validation, &fold.split.test};
    for (const Judge& judge : fold.judges) all.push_back(&judge.rows);
    for (const pinnquad::RowSet* rows : all) {
      fnv.absorb_word(rows->pieces().size());
      for (const pinnquad::FlightRows& piece : rows->pieces()) {
        fnv.absorb_word(hash_of(*piece.flight));
        fnv.absorb_word(piece.rows.begin);
        fnv.absorb_word(piece.rows.end);
        pinnquad::detail::absorb_number(fnv, piece.flight->weight);
      }
    }
    return fnv.hash;
  }

  /// Every flight's content once: a key is asked for each job.
  std::uint64_t hash_of(const pinnquad::Flight& flight) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = hashes_.find(&flight);
    return known != hashes_.end() ? known->second : hashes_[&flight] = pinnquad::content_hash(flight);
  }

  std::string path_of(const FinishedFit& job) const {
    return folder_ + "/" + plan_.kinds[job.kind].key + "-" + std::to_string(job.seed) + "-" +
           std::to_string(job.fold + 1) + ".fit";
  }

  std::string folder_;
  const FitPlan& plan_;
  std::uint64_t of_plan_;
  mutable std::mutex mutex_;
  mutable std::map<const pinnquad::Flight*, std::uint64_t> hashes_;
};

}  // namespace programs
