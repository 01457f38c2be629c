// SPDX-License-Identifier: MIT
// The module pinnquad._core where it is shipped for several instruction sets: loads the best build beside this file.
#include <Python.h>

#include <exception>
#include <filesystem>

#include <dlfcn.h>

#include "command_line/best_build.hpp"

PyMODINIT_FUNC PyInit__core() {
  try {
    Dl_info here{};
    ::dladdr(reinterpret_cast<void*>(&PyInit__core), &here);
    const std::string stem = (std::filesystem::path(here.dli_fname).parent_path() / "_core").string();
    const std::string best = programs::best_build(stem, ".so", stem + "-x86-64.so");
    void* const module = ::dlopen(best.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const init = module == nullptr ? nullptr : ::dlsym(module, "PyInit__core");
    if (init != nullptr) return reinterpret_cast<PyObject* (*)()>(init)();
    PyErr_SetString(PyExc_ImportError, ::dlerror());
  } catch (const std::exception& error) {
    PyErr_SetString(PyExc_ImportError, error.what());
  }
  return nullptr;
}
