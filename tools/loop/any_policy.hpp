// SPDX-License-Identifier: MIT
// Any feed-forward policy behind one type, so that a closed loop is compiled once; and the time that it takes.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>

#include "pinnquad/control/tracking_controller.hpp"

namespace programs {

class AnyPolicy {
  using State = pinnquad::State<double>;
  using Motion = pinnquad::Accelerations<double>;
  using Commands = pinnquad::Commands<double>;

 public:
  template <class Policy>
  explicit AnyPolicy(Policy policy) : held_(std::make_shared<Held<Policy>>(std::move(policy))) {}

  pinnquad::Status operator()(const State& state, const Motion& wanted, std::uint64_t time_us,
                              Commands& commands) noexcept {
    if (held_->answers++ % measured_every != 0) return held_->answer(state, wanted, time_us, commands);
    const Timed timed(*held_);
    return held_->answer(state, wanted, time_us, commands);
  }
  void learn(std::uint64_t now_us, bool known, const State& state, const Commands& commands) noexcept {
    if (held_->lessons++ % measured_every != 0) return held_->learn(now_us, known, state, commands);
    const Timed timed(*held_);
    held_->learn(now_us, known, state, commands);
  }
  void integrate(const Motion& feedback) noexcept { held_->integrate(feedback); }
  pinnquad::Vector3<double> across_m_s2(const State& state) const noexcept { return held_->across_m_s2(state); }
  /// Whether that depends on the state.
  bool across_varies() const noexcept { return held_->varies; }
  pinnquad::FallbackCount count() const noexcept { return held_->count(); }
  /// A bias that it learns stands at its bound.
  bool at_bound() const noexcept { return held_->at_bound(); }
  /// Time of the policy alone, since it was made: by one call of `measured_every`, for a clock takes as long as a tick
  /// of some.
  double busy_s() const noexcept { return measured_every * std::chrono::duration<double>(held_->busy).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr unsigned measured_every = 17;  ///< a multiple of no period of a policy
  template <class Policy>
  using AtBound = decltype(std::declval<const Policy&>().at_bound());
  struct Any {
    explicit Any(bool across_varies) : varies(across_varies) {}
    virtual ~Any() = default;
    virtual pinnquad::Status answer(const State&, const Motion&, std::uint64_t, Commands&) noexcept = 0;
    virtual void learn(std::uint64_t, bool, const State&, const Commands&) noexcept = 0;
    virtual void integrate(const Motion&) noexcept = 0;
    virtual pinnquad::Vector3<double> across_m_s2(const State&) const noexcept = 0;
    virtual pinnquad::FallbackCount count() const noexcept = 0;
    virtual bool at_bound() const noexcept = 0;
    const bool varies;
    Clock::duration busy{0};
    unsigned answers = 0, lessons = 0;
  };
  template <class Policy>
  struct Held final : Any {
    explicit Held(Policy p) : Any(pinnquad::across_varies<Policy, double>), policy(std::move(p)) {}
    pinnquad::Status answer(const State& state, const Motion& wanted, std::uint64_t time_us,
                            Commands& commands) noexcept override {
      return policy(state, wanted, time_us, commands);
    }
    void learn(std::uint64_t now_us, bool known, const State& state, const Commands& commands) noexcept override {
      if constexpr (pinnquad::learns_in_flight<Policy, double>) policy.learn(now_us, known, state, commands);
    }
    void integrate(const Motion& feedback) noexcept override {
      if constexpr (pinnquad::integrates_feedback<Policy, double>) policy.integrate(feedback);
    }
    pinnquad::Vector3<double> across_m_s2(const State& state) const noexcept override {
      return pinnquad::across_of(policy, state);
    }
    pinnquad::FallbackCount count() const noexcept override { return pinnquad::fallback_count(policy); }
    bool at_bound() const noexcept override {
      if constexpr (pinnquad::is_detected<AtBound, Policy>) return policy.at_bound();
      return false;
    }
    Policy policy;
  };
  struct Timed {
    explicit Timed(Any& any) : of(any) {}
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;
    ~Timed() { of.busy += Clock::now() - start; }
    Any& of;
    Clock::time_point start = Clock::now();
  };

  std::shared_ptr<Any> held_;
};

}  // namespace programs
