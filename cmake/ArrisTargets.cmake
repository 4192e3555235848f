# Build rules that every room shares: warnings, sanitizers, one static library a room, one test program a folder.

add_library(arris_warnings INTERFACE)
target_compile_options(arris_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wno-sign-conversion
                                                $<$<BOOL:${ARRIS_WERROR}>:-Werror>
                                                # "text" + std::string is reported wrongly by g++ 12 (bug 105651)
                                                $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

# No contraction: the same bytes whatever instructions the CPU has (ARCHITECTURE.md, "The same bytes").
add_compile_options(-ffp-contract=off)
if(ARRIS_SANITIZE)
  add_compile_options(-fsanitize=${ARRIS_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ARRIS_SANITIZE})
  # With AddressSanitizer Eigen would take its own aligned allocator, and what Debian's Ceres got from malloc would be
  # freed by it.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
  if(ARRIS_SANITIZE STREQUAL "thread")
    add_compile_definitions(ARRIS_PARALLEL_JTHREAD) # Debian's TBB is not instrumented
  endif()
endif()

find_program(ARRIS_CCACHE ccache)
if(ARRIS_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ARRIS_CCACHE})
endif()

# arris_module(name [FOLDERS ..] [EXCLUDE ..] [USES ..] [HIDES ..]): the .cpp files of the folder (and of FOLDERS)
#   USES   linked PUBLIC: our own targets and Eigen, what headers may show
#   HIDES  linked PRIVATE: third-party libraries that stay in .cpp files
function(arris_module name)
  cmake_parse_arguments(M "" "" "FOLDERS;EXCLUDE;USES;HIDES" ${ARGN})
  set(patterns *.cpp)
  foreach(folder ${M_FOLDERS})
    list(APPEND patterns ${folder}/*.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  foreach(file ${M_EXCLUDE})
    list(REMOVE_ITEM sources ${CMAKE_CURRENT_SOURCE_DIR}/${file})
  endforeach()
  add_library(arris_${name} STATIC ${sources})
  add_library(arris::${name} ALIAS arris_${name})
  target_include_directories(arris_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(arris_${name} PUBLIC ${M_USES} PRIVATE arris_warnings ${M_HIDES})
endfunction()

# arris_tests(name [LABEL fast] [TIMEOUT 300] LINKS ..): the folder's .cpp files as one GoogleTest program,
# tests prefixed "name.". A suite whose name begins with Slow or Soak is labelled slow or slow_soak whatever LABEL says
# (ctest -L takes a part of a label); a soak test reads ARRIS_SOAK and runs a twentieth of its count unless that is 1.
function(arris_tests name)
  cmake_parse_arguments(T "" "LABEL;TIMEOUT" "LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  if(NOT T_LABEL)
    set(T_LABEL fast)
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  add_executable(test_${name} ${sources})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(test_${name} PRIVATE ${T_LINKS} GTest::gtest_main arris_warnings)
  target_compile_definitions(test_${name} PRIVATE ARRIS_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                                  ARRIS_BINARY_DIR="${PROJECT_BINARY_DIR}")
  _arris_discover(${name} "-Slow*:*/Slow*:Soak*:*/Soak*" "${T_LABEL}" ${T_TIMEOUT})
  _arris_discover(${name} "Slow*:*/Slow*" "slow" 600)
  _arris_discover(${name} "Soak*:*/Soak*" "slow_soak" 7200)
endfunction()

# One ctest test a GoogleTest case that the filter picks. COST orders a parallel run: fast tests begin first.
function(_arris_discover name filter label timeout)
  set(cost 1)
  if(label STREQUAL "fast")
    set(cost 100)
  endif()
  if(ARRIS_SANITIZE)
    math(EXPR timeout "4 * ${timeout}")
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." TEST_FILTER "${filter}" DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS "${label}" TIMEOUT ${timeout} COST ${cost})
endfunction()
