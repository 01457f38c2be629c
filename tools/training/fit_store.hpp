// SPDX-License-Identifier: MIT
// Finished fits in a folder, so that a training that was interrupted goes on where it was: what each answered, not the
// model itself, which the same rows and seed give again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "command_line/folders.hpp"
#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "training/fits.hpp"

namespace programs {

class FitStore : public KnownFits {
 public:
  /// The folder is made when the first fit comes.
  FitStore(std::string folder, const FitPlan& plan)
      : folder_(std::move(folder)), plan_(plan), of_plan_(plan_hash(plan)) {}

  /// Fills a job that an earlier run of this very program has finished on the same rows. False if there is none; a file
  /// that is not whole, or of another training, is none.
  bool load(FinishedFit& job) const override {
    std::ifstream file(path_of(job), std::ios::binary);
    Head head{};
    if (!read(file, head) || std::memcmp(head.magic, Head{}.magic, sizeof head.magic) != 0 || head.key != key_of(job))
      return false;
    FinishedFit loaded = job;
    const std::size_t rows = plan_.folds[job.fold].split.test.size();
    if (head.rows != rows) return false;
    loaded.held_out.resize(rows);
    for (auto& row : loaded.held_out) {
      if (!read(file, row)) return false;
    }
    if (!read(file, loaded.guard)) return false;
    loaded.chosen_by.resize(head.judges <= most_judges ? head.judges : 0);
    for (double& error : loaded.chosen_by) {
      if (!read(file, error)) return false;
    }
    static_cast<FitFigures&>(loaded) = head.figures;
    job = std::move(loaded);
    return true;
  }

  /// Throws OutputError.
  void keep(const FinishedFit& job) const override {
    make_folders(folder_);
    Head head{};
    head.key = key_of(job);
    head.rows = job.held_out.size();
    head.figures = job;
    head.judges = job.chosen_by.size();
    pinnquad::AtomicFile file(path_of(job));
    write(file.stream(), head);
    for (const auto& row : job.held_out) write(file.stream(), row);
    write(file.stream(), job.guard);
    for (const double error : job.chosen_by) write(file.stream(), error);
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
  static constexpr std::uint64_t most_judges = 100000;  // a broken file asks for no more

  /// As this machine has it in memory: such a file is read by the program that wrote it.
  struct Head {
    char magic[8] = {'p', 'q', '-', 'f', 'i', 't', '-', '7'};
    std::uint64_t key = 0, rows = 0, judges = 0;
    FitFigures figures;
  };
  static_assert(std::is_trivially_copyable_v<Head>);

  template <class Value>
  static bool read(std::istream& from, Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    return static_cast<bool>(from.read(reinterpret_cast<char*>(&value), sizeof value));
  }
  template <class Value>
  static void write(std::ostream& to, const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    to.write(reinterpret_cast<const char*>(&value), sizeof value);
  }

  static bool read(std::istream& from, GuardCounts& guard) {
    std::uint64_t features = 0, length = 0;
    for (std::uint64_t* count : {&guard.rows, &guard.warming_up, &guard.outside_envelope, &guard.output_not_finite,
                                 &guard.beyond_limits, &features}) {
      if (!read(from, *count)) return false;
    }
    for (; features > 0; --features) {
      constexpr std::uint64_t longest = 4096;  // of a name: a broken file asks for no more
      if (!read(from, length) || length > longest) return false;
      std::string name(length, ' ');
      if (!from.read(name.data(), static_cast<std::streamsize>(length)) || !read(from, guard.furthest[name]))
        return false;
    }
    return true;
  }
  static void write(std::ostream& to, const GuardCounts& guard) {
    for (const std::uint64_t count : {guard.rows, guard.warming_up, guard.outside_envelope, guard.output_not_finite,
                                      guard.beyond_limits, std::uint64_t{guard.furthest.size()}}) {
      write(to, count);
    }
    for (const auto& [name, count] : guard.furthest) {
      write(to, std::uint64_t{name.size()});
      to.write(name.data(), static_cast<std::streamsize>(name.size()));
      write(to, count);
    }
  }

  static void absorb(pinnquad::detail::Fnv1a& fnv, double value) { pinnquad::detail::absorb_number(fnv, value); }

  /// The program (by size and time of its file), the airframe, what the flights lack, what was asked for.
  static std::uint64_t plan_hash(const FitPlan& plan) {
    pinnquad::detail::Fnv1a fnv;
    std::error_code ignored;
    const std::filesystem::path program = "/proc/self/exe";
    const auto size = std::filesystem::file_size(program, ignored);
    fnv.absorb_word(ignored ? 0 : size);
    const auto time = std::filesystem::last_write_time(program, ignored);
    fnv.absorb_word(ignored ? 0 : static_cast<std::uint64_t>(time.time_since_epoch().count()));
    const pinnquad::Airframe<double>& a = plan.airframe.value;
    for (const double v : {a.mass_kg, a.thrust_coefficient, a.power_coefficient, a.propeller_diameter_m,
                           a.max_rotor_speed_rev_s, a.rotor_time_constant_s}) {
      absorb(fnv, v);
    }
    for (const auto* triple : {&a.inertia_kg_m2, &a.inertia_products_kg_m2, &a.drag_area_m2}) {
      for (const double v : *triple) absorb(fnv, v);
    }
    for (const auto& rotor : a.rotors) {
      for (const double v : {rotor.x_m, rotor.y_m, rotor.z_m, rotor.thrust_scale, rotor.thrust_curve,
                             static_cast<double>(static_cast<int>(rotor.spin))}) {
        absorb(fnv, v);
      }
    }
    for (const std::string& name : plan.absent) fnv.absorb_text(name);
    absorb(fnv, plan.sample_period_s);
    absorb(fnv, plan.past.delay_s);
    absorb(fnv, plan.past.least_time_constant_s);
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
