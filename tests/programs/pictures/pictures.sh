# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# The pictures that gnuplot draws: named for a screen reader, colours of speed that only get lighter, dots that stand out
# from their ground, bars that can be read. Luminance and contrast as WCAG 2.2 defines them.
#   pictures.sh <pictures_driver> <source folder> <work folder>
source "$(dirname "$0")/../common.sh" "$1" "$2" "$3" - -
driver=$1
project=$2
if ! command -v gnuplot >/dev/null; then
  echo "skipped: no gnuplot (Debian: gnuplot-nox)"
  exit 77
fi
"$driver" . || fail "nothing was drawn"

# luminances <rows of "r g b">: the relative luminance of each
luminances() {
  awk 'function linear(c) { c /= 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ^ 2.4 }
    { printf "%.6f\n", 0.2126 * linear($1) + 0.7152 * linear($2) + 0.0722 * linear($3) }' "$1"
}
# rising <rows of "r g b"> <least rows> <what>: from nearly black to nearly white without a step back
rising() {
  luminances "$1" | awk -v least="$2" '
    NR == 1 && $1 > 0.03 { print "begins at " $1; bad = 1 }
    NR > 1 && $1 < last { print "row " NR " is darker than the one before"; bad = 1 }
    { last = $1 }
    END { if (NR < least) print NR " colours"; if (last < 0.7) print "ends at " last; exit bad || NR < least || last < 0.7 }' ||
    fail "$3 does not get lighter all along: $(tr '\n' ',' <"$1")"
}
# plot <picture> <id>: what gnuplot drew as that curve
plot() { sed -n "/<g id=\"gnuplot_plot_$2\"/,/<g id=\"gnuplot_plot_/p" "$1" | sed '$d'; }
# colour: of the curve that is read, not of its name in the key, as "r g b"
colour() { sed -n '/<g transform/d; s/.*\(stroke\|fill\|color\) *= *["'"'"']rgb( *\([0-9]*\), *\([0-9]*\), *\([0-9]*\)).*/\2 \3 \4/p' | awk 'NR == 1'; }
# stands_out <picture> <id> <what>: 3:1 against white, as graphical objects need
stands_out() {
  plot "$1" "$2" | colour >colour.txt
  [ -s colour.txt ] || fail "$1: no colour of $3"
  luminances colour.txt | awk '{ exit 1.05 / ($1 + 0.05) < 3 }' ||
    fail "$1: $3 is too pale: $(cat colour.txt)"
}

for picture in *.svg; do
  grep -q '<svg role="img"' "$picture" || fail "$picture is no image to a screen reader"
  title=$(sed -n '0,/<title>/s/^<title>\(.*\)<\/title>$/\1/p' "$picture")
  [ "${#title}" -gt 15 ] || fail "the title of $picture: '$title'"
  grep -qE '^<desc>.{60,}</desc>$' "$picture" || fail "$picture has no description"
  ! grep -qE '<title>(Gnuplot|gnuplot_plot_|\$)|Produced by GNUPLOT' "$picture" || fail "$picture: gnuplot's own names"
  grep -q '<rect x="0" y="0" width="[0-9]*" height="[0-9]*" fill="#ffffff"/>' "$picture" || fail "$picture has no ground"
  ! command -v xmllint >/dev/null || xmllint --noout "$picture" || fail "$picture is no XML"
done
grep -q '^<desc>.*a &amp; b' ellipses.svg || fail "the description of ellipses.svg lost a model's name"

# speed_steps <picture> <steps>: half a metre per second each, as lines and as the box that explains them
speed_steps() {
  local step
  for ((step = 0; step < $2; ++step)); do plot "$1" $((step + 5)) | colour; done >lines.txt
  rising lines.txt "$2" "the path in $1"
  sed -n "s/.*<polygon fill = 'rgb( *\([0-9]*\), *\([0-9]*\), *\([0-9]*\))'.*/\1 \2 \3/p" "$1" | uniq >box.txt
  cmp lines.txt box.txt || fail "the box in $1 does not explain the path's colours: $(tr '\n' ',' <box.txt)"
}
speed_steps trajectory.svg 16
speed_steps slow_trajectory.svg 6
sed -n 's/^ *\[\([0-9]*\), \([0-9]*\), \([0-9]*\)\],$/\1 \2 \3/p' "$project/tools/replay/src/ramp.js" >page.txt
rising page.txt 8 "the replay page"
tr -d ' \n' <"$project/tools/pictures/viridis.hpp" | grep -oE '\{[0-9]+,[0-9]+,[0-9]+\}' | tr -d '{}' | tr ',' ' ' >pictures.txt
cmp page.txt pictures.txt || fail "the pictures and the replay page colour speed differently"

# where the path is: two ends, three shadows; that on the floor is an ellipse about as wide as the box allows
for name in start end 'shadows on floor and walls'; do
  grep -q ">$name<" trajectory.svg || fail "trajectory.svg does not name: $name"
done
for shadow in 1 2 3; do
  [ "$(plot trajectory.svg $shadow | grep -oE '[0-9.]+,[0-9.]+' | wc -l)" -gt 300 ] || fail "shadow $shadow is missing"
done

for curve in 1a 2a 3a 4a; do stands_out ellipses.svg $curve "curve $curve"; done
for curve in 1 2; do stands_out prediction.svg $curve "curve $curve"; done

# bars <picture>: their heights in pixels
bars() {
  sed -n "s/.*<polygon .*points = '[0-9.]*,\([0-9.]*\) [0-9.]*,[0-9.]* [0-9.]*,\([0-9.]*\) .*/\1 \2/p" "$1" | awk '{ print $1 - $2 }'
}
bars even_errors.svg >even.txt
[ "$(wc -l <even.txt)" -eq 3 ] || fail "even_errors.svg has not one panel of three bars: $(cat even.txt)"
! grep -q 'scale of its own' even_errors.svg || fail "even_errors.svg takes bars apart that can be compared"
bars errors.svg >bars.txt
grep -q '>without linearized: scale of its own<' errors.svg || fail "errors.svg does not say what its second panel is"
# by the given errors, from zero in both panels: 54.9, 8.0, 7.3 | 8.0, 7.3
awk '{ height[NR] = $1 } function near(a, b) { return (a / b - 1) ^ 2 < 0.0001 }
  END { exit !(NR == 5 && near(height[1] / height[2], 54.9 / 8) && near(height[2] / height[3], 8 / 7.3) &&
               near(height[4] / height[5], 8 / 7.3) && height[5] > 200) }' bars.txt ||
  fail "the bars of errors.svg are not the errors: $(tr '\n' ' ' <bars.txt)"
