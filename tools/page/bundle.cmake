# SPDX-License-Identifier: MIT
#
# Installs the locked packages into the folder PACKAGES and runs bundle.mjs, which writes to FOLDER. Run by the target watch_page
# with NODE, NPM, SOURCE, PACKAGES, FOLDER, BUILD and REQUIRED (ON or AUTO). What fails under AUTO is a notice.
file(MAKE_DIRECTORY "${FOLDER}")

macro(give_up what output)
  file(REMOVE "${FOLDER}/watch.json" "${FOLDER}/charts.json") # of older sources they would be a lie
  if(REQUIRED STREQUAL "AUTO")
    message(NOTICE "pinnquad: ${what}, so pages have tables instead of charts and fly --watch has no page. With a network: cmake ${BUILD} && cmake --build ${BUILD} --target watch_page\n${output}")
    return()
  endif()
  message(FATAL_ERROR "pinnquad: ${what}. It said:\n${output}")
endmacro()

# npm only when the lock file has changed since it last succeeded
file(SHA256 "${SOURCE}/package-lock.json" lock)
set(stamp "${PACKAGES}/node_modules/.pinnquad-lock-${lock}")
if(NOT EXISTS "${stamp}")
  file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" DESTINATION "${PACKAGES}")
  # --ignore-scripts: no package runs code of its own while it is installed
  execute_process(
    COMMAND "${NPM}" ci --ignore-scripts --no-audit --no-fund --no-update-notifier --loglevel=error --fetch-retries=1
    WORKING_DIRECTORY "${PACKAGES}" RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output TIMEOUT 300)
  if(NOT code EQUAL 0)
    give_up("npm could not install the packages of its pages" "${output}")
  endif()
  file(WRITE "${stamp}" "")
endif()

execute_process(
  COMMAND "${NODE}" "${SOURCE}/bundle.mjs" "${PACKAGES}" "${FOLDER}"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output TIMEOUT 120)
if(NOT code EQUAL 0)
  give_up("the page to watch a flight and the charts could not be bundled" "${output}")
endif()
message(NOTICE "${output}")
