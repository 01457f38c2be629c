#include "pinnquad/nn/a.hpp"
pinnquad::Needed needed;  // not Mentioned
