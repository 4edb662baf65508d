# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=... -DWRITTEN=... -DFOLDER=... -P manual.cmake: puts the manual together in FOLDER,
# without links out of it: resources/manual/*.md (not its README.md), the pages below, the pages
# that the programs wrote into the folder WRITTEN, and the pictures that they show. Links to a page
# lead to its place in FOLDER; of other links into the source the text is left.
cmake_minimum_required(VERSION 3.22)

# Pages that lie next to what they describe, each with its name in the manual.
set(taken
  sessions/session/README.md session_files.md
  sessions/evaluation/README.md results_files.md
  sessions/tables/README.md tables.md
  sessions/review/README.md validated_pose.md
  sessions/annotation/README.md annotations.md
  sessions/exchange/README.md exchange.md
  sessions/examples/README.md examples.md
  sessions/record/README.md replay.md
  sessions/baselines/README.md methods.md
  sessions/io/cameras/cameras.md cameras.md
  sessions/io/images/planetary.md image_labels.md
  core/record/FORMAT.md onboard_record.md
  resources/evidence/README.md evidence.md
  resources/evidence/accuracy.md accuracy.md
  resources/evidence/paper.md paper.md
  resources/evidence/peers.md peers.md
  resources/evidence/robustness.md robustness.md
  resources/evidence/speed_and_memory.md speed_and_memory.md
  resources/evidence/trust.md trust.md
  resources/matchers/README.md matchers.md)

set(pages "")
while(taken)
  list(POP_FRONT taken page name)
  set(name_of_${SOURCE}/${page} ${name})
  list(APPEND pages ${SOURCE}/${page})
endwhile()
file(GLOB own ${SOURCE}/resources/manual/*.md)
list(REMOVE_ITEM own ${SOURCE}/resources/manual/README.md)
file(GLOB written ${WRITTEN}/*.md)
foreach(page IN LISTS own written)
  cmake_path(GET page FILENAME name)
  set(name_of_${SOURCE}/resources/manual/${name} ${name})  # by which others link to it
  set(name_of_${page} ${name})
  list(APPEND pages ${page})
endforeach()

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/pictures)
string(ASCII 1 link)  # a bracket would keep CMake from telling the elements of a list apart
foreach(page IN LISTS pages)
  file(READ ${page} text)
  cmake_path(GET page PARENT_PATH folder)
  string(REPLACE "](" "${link}(" text "${text}")
  string(REGEX MATCHALL "${link}\\([^()\n ]+\\)" targets "${text}")
  list(REMOVE_DUPLICATES targets)
  foreach(item IN LISTS targets)
    string(REGEX REPLACE "^.\\((.*)\\)$" "\\1" target "${item}")
    string(REGEX MATCH "#.*$" anchor "${target}")
    string(REGEX REPLACE "#.*$" "" file "${target}")
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${folder} NORMALIZE)
    if(target MATCHES "://" OR target MATCHES "^#" OR folder STREQUAL "${WRITTEN}")
      continue()
    elseif(DEFINED name_of_${file})
      string(REPLACE "${item}" "${link}(${name_of_${file}}${anchor})" text "${text}")
    elseif(file MATCHES "[.]png$" AND EXISTS ${file})
      cmake_path(GET file FILENAME name)
      file(COPY_FILE ${file} ${FOLDER}/pictures/${name})
      string(REPLACE "${item}" "${link}(pictures/${name})" text "${text}")
    else()
      string(REGEX REPLACE "([][().+*?^$|\\\\])" "\\\\\\1" pattern "${item}")
      string(REGEX REPLACE "!?\\[([^\n[]*)${pattern}" "\\1" text "${text}")
    endif()
  endforeach()
  string(REPLACE "${link}(" "](" text "${text}")
  file(WRITE ${FOLDER}/${name_of_${page}} "${text}")
endforeach()
