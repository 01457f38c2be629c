# SPDX-License-Identifier: MIT
#
# Takes a Markdown document apart, for check.sh. Writes into the folder `out`:
#   blocks          one line per fenced block: line of the fence, language, run|skip|from|output, argument (tab-separated)
#   `console` blocks are commands to type: skip, without a reason
#   <line>.code     the block; <line>.given what a hidden comment above it adds, its first line in <line>.given_line
#   spans           inline code outside of blocks: line, text (tab-separated)
# Hidden comments that stand right above a fence:
#   <!-- not run: reason -->          skip
#   <!-- from: examples/a.cpp -->     the block is that file without the comment at its head
#   <!-- output of: command -->       every line that the command writes stands in the block
#   <!-- given: text -->              what must stand around it; may have many lines. Code is put where it has the line
#                                     "...", else after it
# Says what is wrong as document:line: message, and then exits with 1.

function fault(line, message) {
  print name ":" line ": " message
  faults++
}

function end_of_directives(line) {
  if (pending) fault(line, "a hidden comment for a block, and no block below it")
  forget()
}

function forget() { action = "run"; argument = ""; given = ""; given_line = 0; pending = 0 }

function directive(line, text,   key) {
  if (match(text, /^(not run|from|output of|given):/) == 0) return
  key = substr(text, 1, RLENGTH - 1)
  text = substr(text, RLENGTH + 1)
  sub(/^[ \t]+/, "", text)
  sub(/[ \t\n]+$/, "", text)
  pending = 1
  if (text == "") { fault(line, "'" key ":' says nothing"); return }
  if (key == "given") {
    sub(/^\n/, "", text)
    given = text
    return
  }
  action = key == "from" ? "from" : key == "output of" ? "output" : "skip"
  argument = text
}

BEGIN {
  forget()
  known = " cpp cmake sh console python text csv "
  previous_blank = 1
}

in_fence {
  if ($0 ~ /^```[ \t]*$/) {
    in_fence = 0
    close(code)
    next
  }
  print > code
  next
}

in_comment {
  if ($0 ~ /-->[ \t]*$/) {
    sub(/[ \t]*-->[ \t]*$/, "")
    directive(comment_line, comment "\n" $0)
    in_comment = 0
  } else {
    comment = comment "\n" $0
  }
  next
}

/^<!--/ {
  text = $0
  sub(/^<!--[ \t]*/, "", text)
  if (text ~ /-->[ \t]*$/) {
    sub(/[ \t]*-->[ \t]*$/, "", text)
    if (text ~ /^given:/) given_line = NR
    directive(NR, text)
  } else {
    in_comment = 1
    comment_line = NR
    comment = text
    if (text ~ /^given:/) given_line = NR + 1
  }
  previous_blank = 0
  next
}

/^```/ {
  language = substr($0, 4)
  sub(/[ \t]+$/, "", language)
  fence_line = NR
  in_fence = 1
  code = out "/" NR ".code"
  printf "" > code
  if (language == "console") action = "skip"
  if (language == "") fault(NR, "a block without a language: cpp, cmake, sh, python, or text for what is no code")
  else if (index(known, " " language " ") == 0 && action != "skip")
    fault(NR, "language '" language "' is not tested: say why, <!-- not run: ... -->")
  print NR "\t" language "\t" action "\t" argument > (out "/blocks")
  if (given != "") {
    print given > (out "/" NR ".given")
    close(out "/" NR ".given")
    print given_line > (out "/" NR ".given_line")
    close(out "/" NR ".given_line")
  }
  forget()
  previous_blank = 0
  next
}

/^ *```/ || /^~~~/ { fault(NR, "a fence that is indented, or of tildes: put ``` at the start of the line") }

/^[ \t]*$/ { previous_blank = 1; next }

{
  end_of_directives(NR)
  indented = $0 ~ /^(    |\t)/
  if (indented && previous_blank && !was_indented) fault(NR, "indented code: fence it, and say its language")
  was_indented = indented  # one fault for a block with blank lines in it
  previous_blank = 0
  rest = $0
  while (match(rest, /`[^`]+`/)) {
    print NR "\t" substr(rest, RSTART + 1, RLENGTH - 2) > (out "/spans")
    rest = substr(rest, RSTART + RLENGTH)
  }
}

END {
  if (in_fence) fault(fence_line, "a block without an end")
  if (in_comment) fault(comment_line, "a comment without an end")
  else end_of_directives(NR)
  exit faults ? 1 : 0
}
