# SPDX-License-Identifier: Apache-2.0
# What Doxygen reads in place of a header of core/: the same lines, and
# - each option's help, unit and range, which visitFields states, as the documentation of its field;
# - a sentence for members that mean the same everywhere.
# A field whose option is not visited stays undocumented, and Doxygen warns.

# The words between the quotes of a statement's strings, joined; `from` counts the strings.
function strings(text, from,    joined, count) {
  joined = ""
  count = 0
  while (match(text, /"([^"\\]|\\.)*"/)) {
    if (++count >= from) joined = joined substr(text, RSTART + 1, RLENGTH - 2)
    text = substr(text, RSTART + RLENGTH)
  }
  return joined
}

function noteOption(text,    unit, range, help, field) {
  help = strings(text, 3)
  match(text, /OptionInfo\{"[^"]*", *"[^"]*"/)
  unit = substr(text, RSTART, RLENGTH)
  sub(/"$/, "", unit)
  sub(/.*"/, "", unit)
  range = substr(text, RSTART + RLENGTH + 1)
  sub(/".*/, "", range)
  gsub(/[ ]*,[ ]*$/, "", range)
  sub(/^[ ]+/, "", range)
  sub(/, */, " ... ", range)
  field = text
  sub(/.*self\./, "", field)
  sub(/\).*/, "", field)
  notes = notes sprintf("/** \\var boresight::%s::%s\n%s Range: %s%s. */\n", struct_name, field,
                        help, range, unit == "" ? "" : " " unit)
}

/^struct [A-Za-z]+/ { struct_name = $2 }

/^ *visit\((OptionInfo\{|$)/ { statement = ""; inside = 1 }
inside {
  statement = statement " " $0
  if ($0 ~ /\);$/) { noteOption(statement); inside = 0 }
}

/^ *template <class Self, class Visitor>$/ {
  print "/** Gives `visit` each field with its name, unit, range and help. */ " $0
  next
}
/ operator==\(const [A-Za-z]+&\) const = default;/ && previous !~ /^ *\/\/\/ / {
  print "/** Equal in every field. */ " $0
  previous = $0
  next
}
# Several variables on a line share its comment.
/^ +(int|double) [a-z_0-9]+(\[[0-9]\])?( = [-0-9.]+)?, .*; +\/\/\/< / {
  note = $0
  sub(/.*\/\/\/< /, "", note)
  variables = $0
  sub(/;.*/, "", variables)
  type = variables
  sub(/^ +/, "", type)
  sub(/ .*/, "", type)
  sub(/^ +[a-z]+ /, "", variables)
  count = split(variables, each, /, /)
  line = ""
  for (i = 1; i <= count; ++i) line = line "/** " note " */ " type " " each[i] "; "
  print line
  previous = $0
  next
}
{ print; previous = $0 }

END { printf "%s", notes == "" ? "" : "namespace boresight {}\n" notes }
