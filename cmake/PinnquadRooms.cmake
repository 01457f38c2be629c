# SPDX-License-Identifier: MIT
#
# The rooms of include/pinnquad in the order of their imports: a room may include itself and those before it.
set(PINNQUAD_ROOMS
  core dynamics aero vehicle nn features outputs model exported inference control
  io data regression schedule loss training simulation evaluation deploy)

# The rooms that fly: no heap, exceptions, RTTI, iostream; they include each other and nothing else.
set(PINNQUAD_FLIGHT_ROOMS core dynamics aero vehicle nn features outputs model exported inference control)
