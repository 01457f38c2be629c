// SPDX-License-Identifier: MIT
// What a model is made of, written down: the identity of its weights on flash. No compiler's word: a layer names itself
// (`static constexpr const char* description`), the library's templates are described here. One that does neither is
// called what the compiler calls it (core/type_text.hpp), which must then be the same from every compiler that is used.
#pragma once

#include <string_view>

#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/core/type_text.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

/// `add(sink)` gives the sink the description's pieces: `sink.add(std::string_view)`, `sink.add(int)`. Specialise it
/// for a template of your own.
template <class T, class = void>
struct Description {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    sink.add(detail::type_text<T>());
  }
};
template <class T>
struct Description<T, std::void_t<decltype(std::string_view(T::description))>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    sink.add(std::string_view(T::description));
  }
};

namespace detail {

/// "name<number>".
template <class Sink>
constexpr void describe_sized(Sink& sink, std::string_view name, int size) {
  sink.add(name);
  sink.add(std::string_view("<"));
  sink.add(size);
  sink.add(std::string_view(">"));
}
/// "name<first, second, ...>".
template <class First, class... More, class Sink>
constexpr void describe_list(Sink& sink, std::string_view name) {
  sink.add(name);
  sink.add(std::string_view("<"));
  Description<First>::add(sink);
  ((sink.add(std::string_view(", ")), Description<More>::add(sink)), ...);
  sink.add(std::string_view(">"));
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
  Description<T>::add(sink);
  fnv.absorb(0);
}

}  // namespace detail

template <>
struct Description<float> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    sink.add(std::string_view("float"));
  }
};
template <>
struct Description<double> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    sink.add(std::string_view("double"));
  }
};
/// By its name of formats 1 and 2: weights on flash keep their identity.
template <int Size>
struct Description<InputSize<Size>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_sized(sink, "pinnquad::Inputs", Size);
  }
};
template <int Size>
struct Description<Dense<Size>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_sized(sink, "pinnquad::Dense", Size);
  }
};
template <int Size>
struct Description<DenseWithoutBias<Size>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_sized(sink, "pinnquad::DenseWithoutBias", Size);
  }
};
template <class Scalar, class InputSize, class... Specs>
struct Description<Network<Scalar, InputSize, Specs...>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_list<Scalar, InputSize, Specs...>(sink, "pinnquad::Network");
  }
};

}  // namespace pinnquad
