"""Al-Faiz, Ali, Miry: Human arm inverse kinematic solution based on geometric relations and optimization."""
