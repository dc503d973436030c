#pragma once
// What a child of the server does: one batch of grains with one mesher.

namespace polyslip::mesh::worker {

/// Reads a batch from the socket, answers grain by grain (mesh/mesher_protocol.hpp), ends the
/// process: code 0, or 1 after a failed grain. CPU time is limited for each grain by the batch's
/// timeout (SIGXCPU), wall time of a grain that waits for nothing by a generous alarm (SIGALRM).
[[noreturn]] void serve_batch(int socket);

}  // namespace polyslip::mesh::worker
