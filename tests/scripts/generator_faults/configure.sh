# SPDX-License-Identifier: MIT
# Never run: generators.sh must find the configures here that name no generator, and only those.
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release
cmake -S "$source" \
  -B "$build" && cmake --build "$build"
cmake --build build && cmake -B build
cd build && cmake ..
# sound
cmake -S . -B build -G Ninja && cmake --build build
cmake --preset native -B build/native
cmake -S . \
  -B build -G Ninja
cmake --install build --prefix "$prefix"
