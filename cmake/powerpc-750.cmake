# SPDX-License-Identifier: Apache-2.0
# A 32-bit big-endian PowerPC 750, the family of processors that fly; run with qemu-ppc -cpu 750.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR powerpc)

set(CMAKE_C_COMPILER powerpc-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER powerpc-linux-gnu-g++)
set(CMAKE_C_FLAGS_INIT "-mcpu=750 -ffp-contract=off")
set(CMAKE_CXX_FLAGS_INIT "-mcpu=750 -ffp-contract=off")
# Nothing of the host is looked for at run time.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-ppc -cpu 750)

# Eigen is headers alone, and the host's are as good as any.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
