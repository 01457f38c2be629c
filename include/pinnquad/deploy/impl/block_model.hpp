// SPDX-License-Identifier: MIT
// Bodies of block_model.hpp.
#pragma once

#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/nn/kernel/pack.hpp"

namespace pinnquad {
namespace detail {

/// No activation, no bound.
PINNQUAD_BODY bool is_affine(const RunTimeNetwork& network) {
  for (int i = 0; i < network.part_count(); ++i) {
    const RunTimeNetwork::Part& part = network.part(i);
    if (part.bounded) return false;
    for (int layer = 0; layer < part.layer_count; ++layer) {
      if (part.layers[layer].outputs == 0) return false;
    }
  }
  return true;
}

}  // namespace detail

template <class Scalar>
void BlockModel::take_derivatives(const RunTimeModel<Scalar>& model) {
  signs_ = axis_signs(model.airframe());
  if (!outputs_.find(model.schema())) {
    const Scalar* affine = model.records().affine;
    const std::vector<double> numbers(affine, affine + rotor_count * (1 + model.network().outputs()));
    outputs_.take_affine(numbers.data(), model.network().outputs());
  }
  outputs_.prepare(model.airframe());
  for (int i = 0; i < model.features().size(); ++i) {
    const ShownAcceleration shown = shown_acceleration(model, i);
    if (shown == ShownAcceleration::none || shown == ShownAcceleration::unknown) continue;
    places_.push_back({static_cast<std::size_t>(i), static_cast<std::size_t>(shown),
                       detail::is_of_present(model.features()[i].name)});
  }
}

template <class Scalar>
void BlockModel::open_as() {
  auto model = std::make_unique<RunTimeModel<Scalar>>();
  if (RunTimeModel<Scalar>::open(data(), length_, *model) != Status::ok) {
    const auto& fault = model->fault();
    refuse(fault.expected, *fault.found == 0 ? number_text(fault.number) : fault.found);
  }
  take_derivatives(*model);
  row_.emplace(RunTimeRow<Scalar>(*model));
  model_ = std::unique_ptr<const RunTimeModel<Scalar>>(std::move(model));
  require_words();
  if (!(golden_difference() <= golden_tolerance)) refuse("golden commands that its weights give", "others");
}

PINNQUAD_BODY void BlockModel::open() {
  using Header = detail::ModelBlockHeader;
  constexpr std::size_t least = Header::size + Header::checksum_size;
  if (length_ < least) {
    refuse("a model block, " + std::to_string(least) + " bytes or more", std::to_string(length_) + " bytes");
  }
  const std::size_t recorded = detail::read_u32(data() + Header::length);
  if (detail::check_bytes(data(), length_) == Status::block_truncated) {
    refuse("the " + std::to_string(recorded) + " bytes that this block records as its length",
           std::to_string(length_) + ": it is cut short, or that number was changed; copy or export it again");
  }
  const bool is_double = detail::read_u32(data() + Header::scalar_bytes) == sizeof(double);
  is_double ? open_as<double>() : open_as<float>();
}

PINNQUAD_BODY std::uint32_t BlockModel::checksum() const noexcept {
  return detail::read_u32(data() + detail::read_u32(data() + detail::ModelBlockHeader::length) -
                          detail::ModelBlockHeader::checksum_size);
}

PINNQUAD_BODY std::string BlockModel::provenance(const char* word) const {
  return with([&](const auto& model) { return printable(model.provenance(word)); });
}

PINNQUAD_BODY std::string BlockModel::answer() const {
  return with([](const auto& model) { return printable(model.records().answer); });
}

PINNQUAD_BODY std::string BlockModel::schema() const {
  return with([](const auto& model) { return printable(model.schema()); });
}

PINNQUAD_BODY const RunTimeNetwork& BlockModel::network() const {
  return with([](const auto& model) -> const RunTimeNetwork& { return model.network(); });
}

PINNQUAD_BODY const RunTimeFeatures& BlockModel::features() const {
  return with([](const auto& model) -> const RunTimeFeatures& { return model.features(); });
}

PINNQUAD_BODY std::string BlockModel::airframe_name() const {
  return with([](const auto& model) { return printable(model.records().vehicle_name); });
}

PINNQUAD_BODY const Airframe<double>& BlockModel::airframe() const {
  return with([](const auto& model) -> const Airframe<double>& { return model.airframe(); });
}

PINNQUAD_BODY std::uint64_t BlockModel::contents_hash() const {
  return with([](const auto& model) { return model.contents_hash(); });
}

PINNQUAD_BODY std::vector<std::string> BlockModel::feature_names() const {
  std::vector<std::string> names;
  for (int i = 0; i < features().size(); ++i) names.emplace_back(features()[i].name);
  return names;
}

PINNQUAD_BODY std::vector<ColumnName> BlockModel::columns() const {
  std::vector<ColumnName> columns;
  for (int i = 0; i < features().column_count(); ++i) {
    const auto [column, unit] = features().column(i);
    columns.push_back({std::string(column), std::string(unit)});
  }
  return columns;
}

PINNQUAD_BODY bool BlockModel::knows_its_features() const {
  return with([](const auto& model) {
    bool known = true;
    for (int i = 0; i < model.features().size(); ++i) {
      known = known && shown_acceleration(model, i) != ShownAcceleration::unknown;
    }
    return known;
  });
}

PINNQUAD_BODY bool BlockModel::is_axis_commands() const {
  return with([](const auto& model) { return model.outputs().is_axis_commands(); });
}

PINNQUAD_BODY bool BlockModel::has_affine_schema() const {
  bool curved = false;
  for (const auto& rotor : airframe().rotors) curved = curved || rotor.thrust_curve > 0;
  return with([&](const auto& model) { return model.outputs().is_affine(curved); });
}

PINNQUAD_BODY std::vector<double> BlockModel::envelope_lower() const {
  return with([](const auto& m) { return numbers_in_double(m.scales().lower, m.features().size()); });
}

PINNQUAD_BODY std::vector<double> BlockModel::envelope_upper() const {
  return with([](const auto& m) { return numbers_in_double(m.scales().upper, m.features().size()); });
}

PINNQUAD_BODY int BlockModel::golden_count() const {
  return with([](const auto& model) { return model.golden_count(); });
}

PINNQUAD_BODY std::vector<double> BlockModel::golden_features(int vector) const {
  return with([&](const auto& m) { return numbers_in_double(m.golden_features(vector), m.features().size()); });
}

PINNQUAD_BODY double BlockModel::golden_difference() const {
  return with([](const auto& model) {
    std::vector<ScalarOf<decltype(model)>> work(model.workspace());
    return static_cast<double>(model.golden_difference(work.data()));
  });
}

PINNQUAD_BODY std::optional<Certificate> BlockModel::certificate() const {
  Certificate certificate;
  const bool has_structure = with([&](const auto& model) { return run_time_certificate(model, certificate); });
  return has_structure ? std::optional(certificate) : std::nullopt;
}

PINNQUAD_BODY std::optional<BlockModel::ProvenSigns> BlockModel::proven_signs() const {
  if (angular_accelerations().empty()) return {};
  BlockModel::ProvenSigns proof;
  proof.structure = certificate();
  if (proof.structure && proof.structure->proven()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      proof.slope[axis] = proof.structure->slope[axis];
      proof.held_slope[axis] = proof.structure->held_slope[axis];
    }
    return proof;
  }
  proof.structure.reset();
  if (!has_affine_schema() || !detail::is_affine(network()) || !knows_its_features()) return {};
  const std::vector<double> anywhere = golden_features(0);
  proof.slope = derivatives(anywhere, false);
  proof.held_slope = derivatives(anywhere, true);
  const auto vehicle = detail::certified_vehicle<AxisCommandOutputs>(airframe());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double floor = std::max(vehicle.least_slope[axis], 0.0);
    if (!(proof.slope[axis] > floor && proof.held_slope[axis] > floor)) return {};
  }
  return proof;
}

PINNQUAD_BODY Commands<double> BlockModel::commands(const std::vector<double>& x) const {
  return with([&](const auto& model) {
    using Scalar = ScalarOf<decltype(model)>;
    const std::vector<Scalar> own(x.begin(), x.end());
    std::vector<Scalar> work(model.workspace());
    Commands<Scalar> u{};
    model.commands(own.data(), u.data(), work.data());
    return detail::in_double(u);
  });
}

PINNQUAD_BODY std::array<double, 3> BlockModel::signed_sums(const Commands<double>& u) const {
  return {signed_sum(signs_[0], u), signed_sum(signs_[1], u), signed_sum(signs_[2], u)};
}

PINNQUAD_BODY AxisSlopes BlockModel::derivatives(const std::vector<double>& x, bool held) const {
  // a value, its derivatives by three angular accelerations, and zeros that fill a pack
  constexpr int numbers = padded<NativePack<double>>(4);
  using Entry = RunTimeNetwork::Values<double, numbers>;
  constexpr std::size_t read = RunTimeOutputs<double>::base_features;
  const auto inputs = std::size_t(network().inputs()), outputs = std::size_t(network().outputs());
  std::vector<Entry> work(inputs + outputs + network().workspace());
  Entry* const y = work.data() + inputs;
  std::vector<double> made(outputs), by_outputs(std::size_t(rotor_count) * outputs);
  std::array<Commands<double>, 3> by_acceleration{};
  double by_x[rotor_count * read];
  with([&](const auto& model) {
    const auto exact = [](auto number) { return static_cast<double>(number); };
    const auto& scales = model.scales();
    for (std::size_t i = 0; i < inputs; ++i) {
      work[i] = {(x[i] - exact(scales.input_mean[i])) / exact(scales.input_deviation[i])};
    }
    for (const AccelerationPlace& place : places_) {
      if (held || place.is_present)
        work[place.feature][place.axis + 1] = 1 / exact(scales.input_deviation[place.feature]);
    }
    network().forward<double, numbers>(model.parameters(), static_cast<const Entry*>(work.data()), y, y + outputs);
    for (std::size_t k = 0; k < outputs; ++k) {
      made[k] = y[k][0] * exact(scales.output_deviation[k]) + exact(scales.output_mean[k]);
    }
    outputs_.slopes(x.data(), made.data(), by_outputs.data(), static_cast<double*>(by_x));
    for (std::size_t rotor = 0; rotor < std::size_t(rotor_count); ++rotor) {
      for (std::size_t k = 0; k < outputs; ++k) {
        const double slope = by_outputs[rotor * outputs + k] * exact(scales.output_deviation[k]);
        for (std::size_t axis = 0; axis < 3; ++axis) by_acceleration[axis][rotor] += slope * y[k][axis + 1];
      }
    }
  });
  for (const AccelerationPlace& place : places_) {
    for (std::size_t rotor = 0; (held || place.is_present) && place.feature < read && rotor < std::size_t(rotor_count);
         ++rotor) {
      by_acceleration[place.axis][rotor] += by_x[rotor * read + place.feature];
    }
  }
  AxisSlopes result{};
  for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = signed_sum(signs_[axis], by_acceleration[axis]);
  return result;
}

PINNQUAD_BODY void BlockModel::require_words() const {
  using detail::StatedNumber;
  const auto require_whole = [this](const char* word, StatedNumber number) {
    const std::string text = provenance(word);
    const bool whole = std::all_of(text.begin(), text.end(), [](char c) { return '0' <= c && c <= '9'; });
    if (!whole || text.size() > 20) refuse(number, text);
  };
  require_whole("seed", StatedNumber::seed);
  require_whole("epochs", StatedNumber::epochs);
  detail::ModelFacts facts = with([](const auto& model) -> detail::ModelFacts { return model.records(); });
  facts.has_r_squared = true;
  for (double* figure : {&facts.test_r_squared, &facts.linear_regression_r_squared}) {
    const bool test = figure == &facts.test_r_squared;
    const std::string text = provenance(test ? "test_r_squared" : "linear_regression_r_squared");
    facts.has_r_squared = facts.has_r_squared && !text.empty();
    if (!text.empty() && !parse_number(text, *figure)) refuse(StatedNumber::r_squared, text);
  }
  const detail::StatedFault fault = detail::fault_of(facts, detail::FiniteNumber{});
  if (fault.number == StatedNumber::r_squared) refuse(fault.number, number_text(fault.value));
  if (fault.number != StatedNumber::none) refuse(fault.number, "another");
}

PINNQUAD_BODY void BlockModel::refuse(detail::StatedNumber number, const std::string& found) const {
  refuse(detail::stated_ranges[static_cast<std::size_t>(number)].expected, found);
}

PINNQUAD_BODY void BlockModel::refuse(const std::string& expected, const std::string& found) const {
  throw InputError(path_, 0, 0, expected, found);
}

PINNQUAD_BODY void BlockModel::answer(const RowSet& rows,
                                      const std::function<void(std::size_t, const BlockModel::AnsweredRow&)>& take,
                                      bool with_derivatives) const {
  with([&](const auto& model) {
    using Scalar = ScalarOf<decltype(model)>;
    const auto taps = std::size_t(model.features().window().taps), size = std::size_t(model.features().size());
    std::vector<RunTimeFeatures::Inputs<Scalar>> inputs(taps);
    std::vector<RunTimeFeatures::Inputs<double>> exact(taps);
    std::vector<Scalar> x(size), work(model.workspace());
    std::vector<double> exact_x(size);
    BlockModel::AnsweredRow answered;
    std::size_t first = 0;
    for (const FlightRows& piece : rows.pieces()) {
      const detail::RunTimeFlightInputs<Scalar> own(model.features(), piece);
      const detail::RunTimeFlightInputs<double> own_in_double(model.features(), piece);
      for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
        if (!own.read(row, inputs.data())) continue;
        model.features().extract(static_cast<const RunTimeFeatures::Inputs<Scalar>*>(inputs.data()), x.data());
        Commands<Scalar> u{};
        model.commands(x.data(), u.data(), work.data());
        answered.features.assign(x.begin(), x.end());
        answered.commands = detail::in_double(u);
        answered.inside_envelope = model.inside_envelope(x.data());
        if (with_derivatives && own_in_double.read(row, exact.data())) {
          model.features().extract(static_cast<const RunTimeFeatures::Inputs<double>*>(exact.data()), exact_x.data());
          answered.derivatives = derivatives(exact_x);
        }
        take(first + row - piece.rows.begin, answered);
      }
      first += piece.rows.size();
    }
  });
}

}  // namespace pinnquad
