"""The energy account of a run."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class EnergyAccount:
    """Energies at the start and the end of a run, works and losses [J].

    Attributes
    ----------
    kinetic_start, potential_start, kinetic_end, potential_end : float
        Energies of the free bodies.
    driven_work : float
        Work of the driven bodies on the other bodies.
    restitution_loss, friction_loss, closing_loss : float
        Losses by restitution in impacts; by friction in impacts and in sustained slip; and at the ends of accumulations
        of impacts and in projections, which move the gaps of closed contacts back to zero, respectively.
    load_work : float
        Work of the loads and of the normal forces of compliant contacts.  The energy of springs and of compliant
        contacts counts here, not in the potential energy.
    exchanged_in_flow : float
        Energy exchanged between events: the integral over time of the sum of three absolute powers, of the forces on
        bodies (such as gravity and loads), of the driven bodies and of friction.
    """

    kinetic_start: float
    potential_start: float
    kinetic_end: float
    potential_end: float
    driven_work: float
    restitution_loss: float
    friction_loss: float
    closing_loss: float
    exchanged_in_flow: float
    load_work: float

    @property
    def change(self) -> float:
        """Change of kinetic and potential energy [J]."""
        return self.kinetic_end + self.potential_end - self.kinetic_start - self.potential_start

    @property
    def loss(self) -> float:
        """Sum of the losses by restitution, friction and closing steps, which end accumulations of impacts [J]."""
        return self.restitution_loss + self.friction_loss + self.closing_loss

    @property
    def exchanged(self) -> float:
        """Energy that changed its form in the run [J]."""
        return self.exchanged_in_flow + abs(self.restitution_loss) + abs(self.friction_loss) + abs(self.closing_loss)

    @property
    def unexplained(self) -> float:
        """Magnitude of the change of kinetic and potential energy that no work and no loss explains [J]."""
        return abs(self.change - self.driven_work - self.load_work + self.loss)

    @property
    def scale(self) -> float:
        """Energy with which the unexplained change is compared [J].

        It is the largest of three energies:

        1. the energy exchanged (:attr:`exchanged`);
        2. the kinetic energy at the start or the end, because a freely tumbling body exchanges hardly any energy;
        3. a millionth of the potential energy, because the other two are nearly zero for a body at rest.
        """
        kinetic = max(self.kinetic_start, self.kinetic_end)
        potential = max(abs(self.potential_start), abs(self.potential_end))
        return max(self.exchanged, kinetic, 1e-6 * potential)

    @property
    def residual(self) -> float:
        """Unexplained change of energy (:attr:`unexplained`) relative to :attr:`scale`; in J if that scale is zero."""
        return self.unexplained / self.scale if self.scale > 0.0 else self.unexplained
