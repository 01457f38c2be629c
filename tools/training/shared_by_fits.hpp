// SPDX-License-Identifier: MIT
// Work that the fits to one parting have in common, whatever kind and seed: rows are read once, and a result that no
// seed changes is made once.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/training/ground_features.hpp"

namespace programs {

class SharedByFits : public std::enable_shared_from_this<SharedByFits> {
 public:
  /// make(), of the first that asks for this name; the others wait for it. What is null is asked for again.
  template <class Value, class Make>
  std::shared_ptr<const Value> once(const std::string& name, const Make& make) {
    std::unique_lock<std::mutex> lock(mutex_);
    Made& made = made_[name];
    lock.unlock();
    const std::lock_guard<std::mutex> making(made.mutex);
    if (!made.value) made.value = make();
    return std::static_pointer_cast<const Value>(made.value);
  }

  /// The same features. While this lives, their rows of a piece are read once, until 256 MiB are kept.
  pinnquad::GroundFeatures keep(pinnquad::GroundFeatures features) {
    features.each_row = keeping(features.type + " in float", features.size(), std::move(features.each_row));
    features.each_exact_row = keeping(features.type, features.size(), std::move(features.each_exact_row));
    return features;
  }

 private:
  struct Made {
    std::mutex mutex;
    std::shared_ptr<const void> value;
  };
  /// Rows that have features.
  struct ReadPiece {
    std::vector<std::size_t> rows;
    std::vector<double> features;
  };

  pinnquad::GroundFeatures::EachRow keeping(std::string type, std::size_t width,
                                            pinnquad::GroundFeatures::EachRow each_row) {
    return [type = std::move(type), width, each_row = std::move(each_row), weak = weak_from_this()](
               const pinnquad::RowSet& rows, const pinnquad::GroundFeatures::Visit& visit) {
      const std::shared_ptr<SharedByFits> shared = weak.lock();
      if (!shared) return each_row(rows, visit);
      for (const pinnquad::FlightRows& piece : rows.pieces()) {
        const pinnquad::RowSet one(*piece.flight, piece.rows);
        std::ostringstream name;
        name << type << ' ' << static_cast<const void*>(piece.flight) << ' ' << piece.rows.begin << ' '
             << piece.rows.end;
        const auto found = shared->once<ReadPiece>(name.str(), [&]() -> std::shared_ptr<const ReadPiece> {
          constexpr std::size_t most_bytes = std::size_t{256} << 20;
          if (shared->kept_bytes_ > most_bytes) return nullptr;
          const auto made = std::make_shared<ReadPiece>();
          each_row(one, [&](const pinnquad::Flight&, std::size_t row, const double* x) {
            made->rows.push_back(row);
            made->features.insert(made->features.end(), x, x + width);
          });
          shared->kept_bytes_ += sizeof(double) * made->features.size();
          return made;
        });
        if (!found) each_row(one, visit);
        for (std::size_t i = 0; found && i < found->rows.size(); ++i) {
          visit(*piece.flight, found->rows[i], found->features.data() + i * width);
        }
      }
    };
  }

  std::mutex mutex_;
  std::map<std::string, Made> made_;
  std::atomic<std::size_t> kept_bytes_{0};
};

}  // namespace programs
