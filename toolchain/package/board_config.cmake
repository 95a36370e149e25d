# The configuration that the package installs: the sample with what a board needs, and a schedule to take the '#' from.
#
#   cmake -DSAMPLE=dicot.toml -DOUTPUT=FILE -P board_config.cmake
file(READ "${SAMPLE}" text)

function(exchange from to)
  string(FIND "${text}" "${from}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "${SAMPLE} has no line '${from}' any more: the package's configuration is made from it")
  endif()
  string(REPLACE "${from}" "${to}" text "${text}")
  set(text "${text}" PARENT_SCOPE)
endfunction()

exchange("#folder = \".\"" "folder = \"/var/lib/dicot/clouds\"")
string(FIND "${text}" "\n[schedule]\n" place)
if(NOT place EQUAL -1)
  exchange("\n[schedule]\n" "\n[schedule]\n# Without an hour there is nothing to run for. Two ways to say them, among others:\n#   at = [\"06:30\", \"12:00\", \"18:30\"]\n#   every = \"2h\", from = \"06:00\", until = \"20:00\"\n")
endif()
file(WRITE "${OUTPUT}" "${text}")
