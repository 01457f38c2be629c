// SPDX-License-Identifier: MIT
// The symbols of model_block.S, around room for a block. Of one source file of a program.
#pragma once

extern "C" unsigned char pinnquad_model_block[];
__asm__(
    ".pushsection .data\n .balign 8\n .global pinnquad_model_block\n pinnquad_model_block: .space 32768\n"
    " .global pinnquad_model_block_end\n pinnquad_model_block_end:\n .popsection\n");
