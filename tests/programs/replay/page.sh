# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# ReplayPage without a browser: what it refuses, that text cannot leave its element, and that the page holds the flight.
#   page.sh <replay_driver> <work folder>
driver=$1
source "$(dirname "$0")/../common.sh" "$driver" - "$2" - -

# without the bundle: one line, before anything flies or is written
expect_line 2 'cannot write out\.html: the replay page is not built.*replay_bundle' "$driver" out.html rows.csv
[ ! -e rows.csv ] || fail "it flew although the page is not built"

printf '<title>@PINNQUAD_TITLE@</title>\n@PINNQUAD_FLIGHT@\nend\n' >page.html
expect_line 2 'cannot write absent/out\.html: ' "$driver" absent/out.html rows.csv 10
expect_line 2 'no rows' "$driver" out.html rows.csv 0

title=$'</title><script>"a" & b</script>\n\x01end'
"$driver" out.html rows.csv 200 "$title"
[ "$(sed -n 1p out.html)" = '<title>&lt;/title&gt;&lt;script&gt;&quot;a&quot; &amp; b&lt;/script&gt;  end</title>' ] ||
  fail "the title was written as: $(sed -n 1p out.html)"
[ "$(sed -n 3p out.html)" = end ] || fail "the end of the page is missing"
[ -z "$(find . -name '*.partial*')" ] || fail "a half-written file was left behind"
sed -n 2p out.html >flight.json
! grep -q '<' flight.json || fail "the flight holds a '<'"

# field <name> <od type> <columns>: an array of the page as text, one row per line
field() {
  sed -n "s/.*\"$1\":\"\([^\"]*\)\".*/\1/p" flight.json | base64 -d |
    od -An -v -w"$(($3 * ${2#?}))" -t "$2" --endian=little
}
# same <name> <od type> <columns> <first column of rows.csv> <unit> <tolerance in SI>
same() {
  tail -n +2 rows.csv | tr ',' ' ' >flown.txt
  field "$1" "$2" "$3" | paste -d' ' - flown.txt >both.txt
  awk -v n="$3" -v first="$4" -v unit="$5" -v tolerance="$6" '
    { for (i = 0; i < n; ++i) { d = $(1 + i) * unit - $(n + first + i); if (d * d > tolerance ^ 2) bad++ } }
    END { if (bad || NR != 200) { print bad + 0 " values of " NR " rows differ"; exit 1 } }' both.txt ||
    fail "$1 of the page is not what was flown"
}
unit=$(sed -n 's/.*"velocity_unit_m_s":\([^,]*\),.*/\1/p' flight.json)
same time_s f4 1 1 1 1e-6
same position_m f4 3 2 1 1e-5
same velocity d2 3 5 "$unit" "$(awk -v u="$unit" 'BEGIN { print 0.51 * u }')"
same attitude d2 4 8 "$(awk 'BEGIN { printf "%.12g", 1 / 32767 }')" 1.6e-5
same commands u2 4 12 "$(awk 'BEGIN { printf "%.12g", 1 / 65535 }')" 8e-6
