/* SPDX-License-Identifier: MIT
 * The weights: a file that `pinnquad train --block` wrote, in flash, aligned as a model block must be. */
    .section .rodata
    .balign 8
    .global pinnquad_model_block
pinnquad_model_block:
    .incbin "model.block"
    .global pinnquad_model_block_end
pinnquad_model_block_end:
