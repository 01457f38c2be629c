from conan import ConanFile
from conan.tools.files import copy


class Pinnquad(ConanFile):
    name = "pinnquad"
    version = "@VERSION@"
    license = "MIT"
    description = "A quadrotor's flights become an inverse-dynamics model that may fly"
    package_type = "header-library"
    requires = "eigen/3.4.0"
    exports_sources = "src/*"
    no_copy_source = True

    def package(self):
        copy(self, "*.hpp", self.source_folder + "/src", self.package_folder + "/include")

    def package_info(self):
        self.cpp_info.bindirs = self.cpp_info.libdirs = []

    def package_id(self):
        self.info.clear()
