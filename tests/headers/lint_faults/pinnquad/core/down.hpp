// SPDX-License-Identifier: MIT
#pragma once
// FAULT imports point up the list of rooms, 'core' comes before 'nn'
// FAULT a room that does not fly
#include <pinnquad/loss/loss.hpp>
#include <pinnquad/nn/layer.hpp>
