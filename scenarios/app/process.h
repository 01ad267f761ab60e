// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline::scenarios {

/// Tunables that make glibc choose the same sin, cos and exp on every x86-64 CPU.
inline constexpr std::string_view hwcaps_tunable =
    "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX,-AVX2_Usable,-FMA_Usable";

/// The value of GLIBC_TUNABLES with ours appended to what is set.
[[nodiscard]] std::string with_hwcaps(std::string_view tunables);

/// Executes this program again with the tunables set, once; glibc reads them only when a process starts. Goes on with
/// a warning where that fails. Does nothing when they are set already.
void reexecute_with_tunables(char** argv);

/// Opens /dev/null where stdin, stdout or stderr is closed, so that no file of ours takes its number; lets a write
/// over a size limit fail instead of killing the process; sets the floating-point mode of this thread.
void settle_process();

/// How many CPUs this process may use.
[[nodiscard]] int allowed_cpus();

}  // namespace plumbline::scenarios
