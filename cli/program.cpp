#include "cli/program.hpp"

#include <exception>
#include <new>
#include <string>

#include "acquisition/types/error.hpp"
#include "cli/command_line.hpp"
#include "cli/console.hpp"
#include "cli/interrupt.hpp"

namespace arris {

int run_program(int argc, const char* const* argv) {
  try {
    catch_interrupts();
    const int code = run_command_line(argc, argv);
    console::flush();
    return code;
  } catch (const Error& error) {
    console::complain(error.what());
    return exit_code(error.fault());
  } catch (const std::bad_alloc&) {
    console::complain(
        "not enough memory: needed more than this machine gives; next: thin the scan (scan.voxel_mm)");
    return exit_code(Fault::kInput);
  } catch (const std::exception& error) {
    console::complain(
        std::string("this is a bug of ours, please report it with the command and its files: ") +
        error.what());
  }
  return exit_code(Fault::kBug);
}

}  // namespace arris
