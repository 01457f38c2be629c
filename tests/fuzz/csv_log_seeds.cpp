// SPDX-License-Identifier: MIT
// Writes small tables, sound and not, into a folder, for the fuzzer to begin with: csv_log_seeds DIR
#include <string>

#include "fuzz/seeds.hpp"

int main(int argument_count, char** arguments) {
  return pinnquad_test::write_seeds(
      argument_count, arguments,
      {
          "t,x,flight\n0.1,1e-3,a\n0.2,,b\n0.3,nan,\n",
          "\xef\xbb\xbft, \"x, y\" ,z\r\n1,-inf,\"two\r\nlines\"\r\n2,+3,\"a \"\"mark\"\"\"\r\n\r\n",
          "t,x\n1,2\n2,3\n3,text\n",
          "t;x\n1;0,5\n2;0,7\n",
          "t,x\n0,1,0,5\n",
          "t\tx\n1\t2\n",
          "1,2\n3,4\n",
          "t,x\n\"0,5\",1\n",
      });
}
