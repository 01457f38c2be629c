#include "pinnquad/nn/a.hpp"
pinnquad::Lonely lonely;
