# SPDX-License-Identifier: MIT
#
# Makes a program of one block and of what is given around it, for check.sh: the code stands where the given text has the
# line "...", else after it; #line lets the compiler's messages name the document.
#   awk -v document=NAME -v first=LINE -v given=FILE -v given_first=LINE -f program.awk CODE
function put_code() {
  if (!placed) print "#line " first " \"" document "\"\n" code
  placed = 1
}

# wherever the code is put, its includes stand at the head
/^#include/ {
  includes = includes "#line " first + FNR - 1 " \"" document "\"\n" $0 "\n"
  code = code "\n"
  next
}
{ code = code $0 "\n" }

END {
  printf "%s", includes
  if (given != "") {
    n = given_first
    print "#line " n " \"" document "\""
    while ((getline text < given) > 0) {
      ++n
      if (text !~ /^[ \t]*\.\.\.[ \t]*$/) { print text; continue }
      put_code()
      print "#line " n " \"" document "\""
    }
  }
  put_code()
}
