// SPDX-License-Identifier: MIT
// The paper's network (Sec. 5.2) for a feature set, with and without batch norm.
#pragma once

#include "pinnquad/features/features.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "study/models.hpp"
#include "training/paper_network.hpp"

namespace study {

namespace detail {
template <class Features, class BatchNormChoice>
struct NetworkOf;
template <class Features>
struct NetworkOf<Features, Without> {
  using type = programs::PaperNetwork<Features>;
};
template <class Features>
struct NetworkOf<Features, With> {
  using type = pinnquad::BatchNormMlp<float, pinnquad::InputSize<Features::size>, pinnquad::Hidden<10, 25>,
                                      pinnquad::OutputSize<pinnquad::rotor_count>, pinnquad::Relu>;
};
}  // namespace detail

/// Ten hidden layers of 25 ReLU. Batch norm stands between Dense and ReLU (docs/paper.md, deviation 15).
template <class Features, class BatchNormChoice>
using PaperNetwork = typename detail::NetworkOf<Features, BatchNormChoice>::type;

}  // namespace study
