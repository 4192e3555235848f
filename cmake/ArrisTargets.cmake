# Build rules that every room shares: warnings, sanitizers, one static library a room, one test program a folder.

add_library(arris_warnings INTERFACE)
target_compile_options(arris_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wno-sign-conversion
                                                $<$<BOOL:${ARRIS_WERROR}>:-Werror>)

# No contraction: the same bytes whatever instructions the CPU has (ARCHITECTURE.md, "The same bytes").
add_compile_options(-ffp-contract=off)
if(ARRIS_SANITIZE)
  add_compile_options(-fsanitize=${ARRIS_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ARRIS_SANITIZE})
  if(ARRIS_SANITIZE STREQUAL "thread")
    add_compile_definitions(ARRIS_PARALLEL_JTHREAD) # Debian's TBB is not instrumented
  endif()
endif()

find_program(ARRIS_CCACHE ccache)
if(ARRIS_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ARRIS_CCACHE})
endif()

# arris_module(name SOURCES .. [USES ..] [HIDES ..])
#   USES   linked PUBLIC: our own targets and Eigen, what headers may show
#   HIDES  linked PRIVATE: third-party libraries that stay in .cpp files
function(arris_module name)
  cmake_parse_arguments(M "" "" "SOURCES;USES;HIDES" ${ARGN})
  add_library(arris_${name} STATIC ${M_SOURCES})
  add_library(arris::${name} ALIAS arris_${name})
  target_include_directories(arris_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(arris_${name} PUBLIC ${M_USES} PRIVATE arris_warnings ${M_HIDES})
endfunction()

# arris_tests(name [LABEL fast] [TIMEOUT 300] SOURCES .. LINKS ..): one GoogleTest program, tests prefixed "name."
function(arris_tests name)
  cmake_parse_arguments(T "" "LABEL;TIMEOUT" "SOURCES;LINKS" ${ARGN})
  if(NOT T_LABEL)
    set(T_LABEL fast)
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  add_executable(test_${name} ${T_SOURCES})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(test_${name} PRIVATE ${T_LINKS} GTest::gtest_main arris_warnings)
  target_compile_definitions(test_${name} PRIVATE ARRIS_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                                  ARRIS_BINARY_DIR="${PROJECT_BINARY_DIR}")
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS ${T_LABEL} TIMEOUT ${T_TIMEOUT})
endfunction()
