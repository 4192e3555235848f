#include "cli/program.hpp"

int main(int argc, char** argv) {
  return arris::run_program(argc, argv);
}
