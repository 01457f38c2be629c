# SPDX-License-Identifier: MIT
#
# Makes one C++ program of a document's C++ blocks, for check.sh. Input: lines of `blocks` that are to be run (line, ...);
# variables: parts (folder of the blocks), document (its name in messages).
# Each block gets a namespace, so that blocks cannot see each other; its #include lines go to the head of the program,
# its main() is called by the program's. A block without main() is compiled only.

function read_part(path, first,   text, n) {
  n = first
  while ((getline text < path) > 0) {
    if (text ~ /^#include/) heads = heads "#line " n " \"" document "\"\n" text "\n"
    part[++parts_read] = text
    part_line[parts_read] = n++
  }
  close(path)
}

BEGIN { FS = "\t" }

{
  line = $1
  parts_read = 0
  first_given = ""
  if ((getline first_given < (parts "/" line ".given_line")) < 0) first_given = ""
  close(parts "/" line ".given_line")
  given_count = 0
  if (first_given != "") { read_part(parts "/" line ".given", first_given); given_count = parts_read }
  read_part(parts "/" line ".code", line + 1)

  # where the code goes: at "...", else after what is given
  place = given_count + 1
  for (i = 1; i <= given_count; ++i) if (part[i] ~ /^[ \t]*\.\.\.[ \t]*$/) place = i
  order = 0
  for (i = 1; i < place; ++i) sequence[++order] = i
  for (i = given_count + 1; i <= parts_read; ++i) sequence[++order] = i
  for (i = place + 1; i <= given_count; ++i) sequence[++order] = i

  text = "namespace block_" line " {\n"
  inside_main = 0
  has_main = 0
  for (k = 1; k <= order; ++k) {
    i = sequence[k]
    statement = part[i]
    if (statement ~ /^#include/) continue
    if (statement ~ /^int main\(\) \{/) { sub(/main/, "example", statement); inside_main = 1; has_main = 1 }
    else if (statement ~ /^int main/) { print document ":" line ": write int main() {"; exit 1 }
    text = text "#line " part_line[i] " \"" document "\"\n"
    # main() may end without a value, example() may not
    if (inside_main && statement ~ /^}/) { text = text "return 0;\n"; inside_main = 0 }
    text = text statement "\n"
  }
  bodies = bodies text "}\n"
  if (has_main) calls = calls "  run(\"" document ":" line "\", block_" line "::example);\n"
}

END {
  print "#include <cstdio>\n#include <exception>\n" heads bodies
  print "#line 1 \"all blocks\""
  print "static int failed = 0;"
  print "[[maybe_unused]] static void run(const char* where, int (*example)()) {"
  print "  int code = 1;"
  print "  try { code = example(); } catch (const std::exception& e) { std::printf(\"%s\\n\", e.what()); }"
  print "  std::printf(\"%s: %s\\n\", where, code == 0 ? \"runs\" : \"a fault: the program failed\");"
  print "  if (code != 0) failed = 1;"
  print "}"
  print "int main() {\n" calls "  return failed;\n}"
}
