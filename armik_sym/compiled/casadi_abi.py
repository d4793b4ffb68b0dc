"""Letting CasADi call a generated C function: the entry points `casadi.external` looks for."""

from __future__ import annotations

from armik_sym.compiled.c_source import CSignature

_TEMPLATE = """\
EXPORT int {abi}(const double **arg, double **res, long long *iw, double *w, int mem) {{
  (void)iw; (void)w; (void)mem;
  if ({all_present}) {name}({call});
  return 0;
}}
EXPORT long long {abi}_n_in(void) {{ return {n_in}; }}
EXPORT long long {abi}_n_out(void) {{ return {n_out}; }}
EXPORT const long long *{abi}_sparsity_in(long long i) {{
  static const long long dense[{n_in}][3] = {{{in_shapes}}};
  return (i >= 0 && i < {n_in}) ? dense[i] : 0;
}}
EXPORT const long long *{abi}_sparsity_out(long long i) {{
  static const long long dense[{n_out}][3] = {{{out_shapes}}};
  return (i >= 0 && i < {n_out}) ? dense[i] : 0;
}}
EXPORT int {abi}_work(long long *sz_arg, long long *sz_res, long long *sz_iw, long long *sz_w) {{
  if (sz_arg) *sz_arg = {n_in};
  if (sz_res) *sz_res = {n_out};
  if (sz_iw) *sz_iw = 0;
  if (sz_w) *sz_w = 0;
  return 0;
}}
"""


def casadi_entry_points(signature: CSignature, abi_name: str) -> str:
    """C source of the entry points through which CasADi calls a generated function.

    Inputs and outputs appear to CasADi as dense column vectors. CasADi passes a null pointer for an
    output nobody asked for; these functions have one output, so nothing is computed then.

    Args:
        signature: The generated function, with one output.
        abi_name: Name under which `casadi.external` finds it.

    Returns:
        C source text, using the macro `EXPORT`.

    Source:
        CasADi user guide, "Using the generated code" (the C interface of external functions).
    """
    n_in, n_out = len(signature.inputs), len(signature.outputs)
    arguments = [f"arg[{i}]" for i in range(n_in)] + [f"res[{i}]" for i in range(n_out)]
    present = [f"arg[{i}]" for i, (_, size) in enumerate(signature.inputs) if size]
    present += [f"res[{i}]" for i in range(n_out)]
    return _TEMPLATE.format(
        abi=abi_name,
        name=signature.name,
        call=", ".join(arguments),
        all_present=" && ".join(present),
        n_in=n_in,
        n_out=n_out,
        in_shapes=", ".join(f"{{{size}, 1, 1}}" for _, size in signature.inputs),
        out_shapes=", ".join(f"{{{size}, 1, 1}}" for _, size in signature.outputs),
    )
