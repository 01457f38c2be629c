// SPDX-License-Identifier: MIT
// Writes mappings, sound and not, into a folder, for the fuzzer to begin with: mapping_seeds DIR
#include <string>

#include "fuzz/seeds.hpp"

int main(int argument_count, char** arguments) {
  const std::string table =
      "[time]\ncolumn = \"t\"\n[attitude]\nquaternion = [\"a\", \"b\", \"c\", \"d\"]\n[body_rates]\n"
      "columns = [\"b\", \"c\", \"d\"]\nunit = \"deg/s\"\n";
  return pinnquad_test::write_seeds(
      argument_count, arguments,
      {table + "[motors]\ncolumns = [\"e\", \"e\", \"e\", \"e\"]\nnumbers = \"signal\"\nleast = 1000\nmost = 2000\n"
               "order = \"betaflight\"\n[velocity]\ncolumns = [\"a\", \"b\", \"c\"]\naxes = \"world\"\n",
       "world = \"enu\"\nbody = \"flu\"\n" + table +
           "[flights]\ncolumn = \"flight\"\ntrajectory = \"*(o)*\"\n[torque_and_thrust]\ntorque = [\"b\", \"c\", "
           "\"d\"]\n"
           "thrust = \"d\"\nthrust_is = \"up\"\n[position]\ncolumns = [\"a\", \"b\", \"e\"]\nunit = \"mm\"\n",
       table +
           "[[motors]]\ntopic = \"y\"\ncolumns = [\"a\", \"b\", \"c\", \"d\"]\norder = \"px4\"\n[[motors]]\n"
           "topic = \"x\"\ncolumns = [\"d\", \"d\", \"d\", \"d\"]\nthrust_curve = 0.5\nnumbers = \"signal\"\n"
           "order = [\"rear_left\", \"rear_right\", \"front_left\", \"front_right\"]\n[specific_force]\n"
           "columns = [\"c\", \"d\", \"d\"]\nunit = \"g\"\n[ground]\nheight_m = \"before_flight\"\nby_contact = true\n"
           "[altitude]\ncolumns = \"e\"\nunit = \"cm\"\n[[extra]]\nname = \"battery\"\nunit = \"V\"\ncolumn = \"f\"\n",
       "[attitude]\neuler = 1\n", "[[[["});
}
