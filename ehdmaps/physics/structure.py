"""A contact is a film between solids: approach, stiffness and damping from the film and the structural law.

    approach = delta_el(w) - h_eff,    1/k = d(delta_el)/dw + film compliance,    c = loss compliance k^2

in the limit of slow motion; for other frequencies see `ehdmaps.physics.spectrum`.
"""

from __future__ import annotations

from typing import Generic, NamedTuple

from ehdmaps.physics._values import Values
from ehdmaps.physics.contact import LineContact


class Structured(NamedTuple, Generic[Values]):
    """What depends on the structural law, per unit length; numbers or arrays.

    Attributes
    ----------
    approach : float or array
        delta_el(w) - h_eff [m], > 0 when the bodies come together.
    stiffness : float or array
        k [N/m2].
    damping : float or array
        c [N s/m2].
    stiffness_error, damping_error : float or array
        Estimated relative numerical errors.
    """

    approach: Values
    stiffness: Values
    damping: Values
    stiffness_error: Values
    damping_error: Values


def structured(
    contact: LineContact,
    load: Values,
    film_offset: Values,
    film_compliance: Values,
    loss_compliance: Values,
    film_compliance_error: Values,
    loss_compliance_error: Values,
) -> Structured[Values]:
    """Add the solids of a contact to its film.

    Errors are carried over to first order: 1/k has the absolute error of the film compliance, and c = loss k^2 has that
    of the loss plus twice that of k, with their signs, and a twentieth of both magnitudes in case they cancel.

    Parameters
    ----------
    contact : LineContact
        The contact, with its structural law.
    load : float or array
        w [N/m].
    film_offset : float or array
        h_eff [m].
    film_compliance : float or array
        -d(h_eff)/dw [m2/N].
    loss_compliance : float or array
        c/k^2 [m2 s/N].
    film_compliance_error, loss_compliance_error : float or array
        Estimated relative errors with their signs; only the sign of one against the other matters.
    """
    compliance = contact.structural_compliance(load) + film_compliance
    stiffness_error = -film_compliance * film_compliance_error / compliance
    both = abs(loss_compliance_error) + 2.0 * abs(stiffness_error)
    return Structured(
        approach=contact.structural_approach(load) - film_offset,
        stiffness=1.0 / compliance,
        damping=loss_compliance / compliance**2,
        stiffness_error=abs(stiffness_error),
        damping_error=abs(loss_compliance_error + 2.0 * stiffness_error) + 0.05 * both,
    )
