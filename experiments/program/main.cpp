#include <malloc.h>

#include <cstdio>

#include "common/blas_threads.h"
#include "experiments/program/program.h"
#include "experiments/support/standard_streams.h"

int main(int argc, char** argv) {
  possibility::experiments::PrepareStandardStreams();
  // Solves allocate and free matrices constantly. Returning the pages to the system and faulting
  // them in again makes threads queue in the kernel (eight solves at a time on two cores: 1.58 to
  // 1.76 times the throughput of one; 1.70 to 1.74 with both thresholds out of reach).
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  possibility::UseOneThreadInBlas();
  if (possibility::BlasIsForOneThread()) {
    std::fputs(
        "possibility: the BLAS of this machine gives wrong results in several threads; unless "
        "--threads says otherwise one is used; install libopenblas0-pthread\n",
        stderr);
  }
  return possibility::experiments::RunProgram(argc, argv);
}
