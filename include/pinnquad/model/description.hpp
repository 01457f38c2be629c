// SPDX-License-Identifier: MIT
// The text that names a model's parts: the identity of its weights on flash. A layer, a base or a predictor names
// itself by a static constexpr member `description`: a text, or detail::TemplateText. A type without one has its name
// from the compiler (core/type_text.hpp), which must then be the same from every compiler that is used.
#pragma once

#include <string_view>
#include <type_traits>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/core/type_text.hpp"
#include "pinnquad/nn/glu.hpp"
#include "pinnquad/nn/layer_norm.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad::detail {

/// "name<first, second, ...>": the description of a class template. Arguments are types, numbers among them as Number.
template <class... Argument>
struct TemplateText {
  std::string_view name;
};
template <int Value>
struct Number {};

template <class T>
using OwnDescription = std::enable_if_t<std::is_object_v<decltype(T::description)>>;
template <class T>
constexpr auto described() noexcept {
  if constexpr (is_detected<OwnDescription, T>) {
    return T::description;
  } else {
    return type_text<T>();
  }
}

/// Description of a type: a text, a number, or a TemplateText.
template <class T>
inline constexpr auto description_of = described<T>();
template <int Value>
inline constexpr int description_of<Number<Value>> = Value;
/// By the name that exported models say: weights on flash keep their identity.
template <int Size>
inline constexpr TemplateText<Number<Size>> description_of<InputSize<Size>>{"pinnquad::Inputs"};
template <int Size>
inline constexpr TemplateText<Number<Size>> description_of<Dense<Size>>{"pinnquad::Dense"};
template <int Size>
inline constexpr TemplateText<Number<Size>> description_of<DenseWithoutBias<Size>>{"pinnquad::DenseWithoutBias"};
template <int Count>
inline constexpr TemplateText<Number<Count>> description_of<LayerNorm<Count>>{"pinnquad::LayerNorm"};
template <int Count>
inline constexpr TemplateText<Number<Count>> description_of<RmsNorm<Count>>{"pinnquad::RmsNorm"};
template <int Count>
inline constexpr TemplateText<Number<Count>> description_of<Glu<Count>>{"pinnquad::Glu"};
template <class Scalar, class InputSize, class... Specs>
inline constexpr TemplateText<Scalar, InputSize, Specs...> description_of<Network<Scalar, InputSize, Specs...>>{
    "pinnquad::Network"};

template <class Sink>
constexpr void add_description(Sink& sink, std::string_view text) {
  sink.add(text);
}
template <class Sink>
constexpr void add_description(Sink& sink, int number) {
  sink.add(number);
}
template <class Sink, class... Argument>
constexpr void add_description(Sink& sink, const TemplateText<Argument...>& text) {
  sink.add(text.name);
  std::string_view before = "<";
  ((sink.add(before), add_description(sink, description_of<Argument>), before = ", "), ...);
  sink.add(std::string_view(">"));
}
/// Gives the sink the pieces of T's description: `sink.add(std::string_view)`, `sink.add(int)`.
template <class T, class Sink>
constexpr void describe(Sink& sink) {
  add_description(sink, description_of<T>);
}

/// A sink of letters one by one, digits among them and spaces left out: `Taker` has `take(char)`.
template <class Taker>
struct LetterSink {
  constexpr void add(std::string_view text) noexcept {
    for (const char c : text) {
      if (c != ' ') static_cast<Taker&>(*this).take(c);
    }
  }
  constexpr void add(int number) noexcept {
    if (number >= 10) add(number / 10);
    static_cast<Taker&>(*this).take(static_cast<char>('0' + number % 10));
  }
};

/// The letters of a description as Fnv1a::absorb_text() takes a text.
struct DescriptionHash : LetterSink<DescriptionHash> {
  Fnv1a& fnv;

  constexpr explicit DescriptionHash(Fnv1a& hash) noexcept : fnv(hash) {}
  constexpr void take(char c) noexcept { fnv.absorb(static_cast<unsigned char>(c)); }
};

template <class T>
constexpr void absorb_description(Fnv1a& fnv) noexcept {
  DescriptionHash sink{fnv};
  describe<T>(sink);
  fnv.absorb(0);
}

}  // namespace pinnquad::detail
